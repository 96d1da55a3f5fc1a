#pragma once

#include "bjontegaard.h"
#include "point.h"
#include "sweep_folder.h"
#include "sweep_plan.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace gimg::gimrd {

/// A coder that was chosen and is not installed, or a program among the adapters that does not work.
struct Absence
{
    std::string coder, title;
    std::vector<std::string> packages; ///< those that are missing
};

/// A sweep as it stands in its folder.
struct SweepResults
{
    std::string command; ///< that makes it, without folders
    int samples = 0;
    std::vector<size_t> sizes;
    struct Column
    {
        std::string id, label;
        bool ours = false;
        nlohmann::ordered_json versions = nlohmann::ordered_json::object();
    };
    std::vector<Column> series; ///< those that have a point
    struct Row
    {
        std::string name, sha256, note;
        int faces = 0;
        double diagonal = 0;
        std::vector<std::vector<std::optional<Point>>> points; ///< [series][size]
    };
    std::vector<Row> meshes;
    std::vector<Absence> skipped;
    std::vector<std::string> broken; ///< adapters that do not describe themselves
};

/// Reads the points of these jobs of a plan; those that are not there stay empty. Series without any are left
/// out.
SweepResults collectResults(const SweepPlan& plan, const std::vector<size_t>& jobs,
                            const std::vector<std::string>& hashes, const SweepFolder& folder, int samples);

/// What a coder has of the row: its finished points.
std::vector<RatePoint> ratePoints(const SweepResults::Row& row, size_t series);

/// Of series `test` against series `reference`: the mean of the deltas over the meshes that have one.
struct MeanBjontegaard
{
    Bjontegaard mean;
    int rateMeshes = 0, psnrMeshes = 0; ///< that it is the mean of
};
MeanBjontegaard meanBjontegaard(const SweepResults& results, size_t reference, size_t test);

/// The mean PSNR of each series at a size, over the meshes where every series has a file of that size. Series
/// without any finished point are left out of that demand.
struct MeanCurves
{
    std::vector<int> meshes;               ///< by size: how many the mean is of
    std::vector<std::vector<double>> psnr; ///< [series][size]; NaN if there is none
};
MeanCurves meanCurves(const SweepResults& results);

bool anyFailed(const SweepResults& results);

/// results.csv: a line for each point.
std::string resultsCsv(const SweepResults& results);
/// results.json: the same, and the Bjontegaard deltas.
nlohmann::ordered_json resultsJson(const SweepResults& results);

} // namespace gimg::gimrd

#pragma once

#include "adapters.h"

#include "gimg/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// What a sweep consists of, decided from the command line and the names of the coders alone, so that every
/// process that runs a part of a sweep numbers its jobs alike.
namespace gimg::gimrd {

/// Samples a side of the geometry image that image coders get of a mesh, unless --grids says otherwise.
inline constexpr int kImageGrid = 257;

/// As on the command line.
struct SweepRequest
{
    std::vector<std::filesystem::path> meshes;
    std::vector<size_t> sizes;
    std::vector<int> grids;                              ///< empty: as each coder chooses
    std::optional<std::vector<std::string>> ours, peers; ///< names; nothing: all; "none": none
};

struct SweepMesh
{
    std::filesystem::path path;
    std::string name;         ///< the stem of the path
    int imageSide = 0;        ///< samples a side if it is a geometry image, otherwise 0
    std::uintmax_t bytes = 0; ///< size of the file; 0 if it is not there
};

/// A coder at a grid: a column of tables, a curve.
struct Series
{
    size_t coder = 0;
    int grid = 0;      ///< samples a side; 0: the coder chooses, or has none
    std::string id;    ///< "gim", "raw-zlib-257"
    std::string label; ///< the coder's title, with the grid where the sweep has the coder at several
};

/// A mesh with a series, at all sizes.
struct Job
{
    size_t mesh = 0, series = 0;
};

struct SweepPlan
{
    std::vector<SweepMesh> meshes;    ///< by name
    std::vector<size_t> sizes;        ///< increasing
    std::vector<CoderProgram> coders; ///< ours first, then by name
    std::vector<Series> series;       ///< as the coders, then by grid
    std::vector<Job> jobs;            ///< mesh after mesh
    std::vector<std::string> named;   ///< coders that were asked for by name
};

/// Errors: BadArgument for an unknown coder (lists the names there are), two meshes of one name, or two
/// series that would write the same files.
Result<SweepPlan> planSweep(const SweepRequest& request, const std::vector<CoderProgram>& coders);

/// Whether a file name says that the file holds a geometry image, as readF32() reads it.
bool isGridImage(const std::filesystem::path& path);

} // namespace gimg::gimrd

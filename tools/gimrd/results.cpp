#include "results.h"

#include "number_text.h"
#include "sweep_run.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gimg::gimrd {
namespace {

using Json = nlohmann::ordered_json;
using State = Point::State;

std::string quoted(const std::string& text)
{
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
}

std::string csvLine(const Point& p)
{
    std::string line = quoted(p.mesh) + ',' + quoted(p.coder) + ',' + std::to_string(p.grid) + ',' +
                       std::to_string(p.target) + ',' + name(p.state);
    if (p.state == State::Done) {
        const SurfaceDistance& d = p.distance;
        line += ',' + std::to_string(p.bytes);
        for (const double value :
             {d.psnr(), d.rmsRefToTest, d.rmsTestToRef, d.maxRefToTest, d.maxTestToRef, d.hausdorff()})
            line += ',' + shortest(value);
        line += ',' + (p.normalError ? shortest(*p.normalError) : std::string());
        line += ',' + std::to_string(p.faces) + ',' + quoted(p.settings.dump());
    } else {
        line += ",,,,,,,,,,";
    }
    return line + ',' + quoted(p.message) + '\n';
}

Json bjontegaardJson(const SweepResults& results)
{
    const auto entry = [&](const Json& mesh, size_t reference, size_t test, const Bjontegaard& delta) {
        return Json{{"mesh", mesh},
                    {"reference", results.series[reference].id},
                    {"test", results.series[test].id},
                    {"bd_rate_percent", delta.ratePercent ? Json(*delta.ratePercent) : Json()},
                    {"bd_psnr_db", delta.psnr ? Json(*delta.psnr) : Json()}};
    };
    Json list = Json::array();
    for (size_t reference = 0; reference < results.series.size(); ++reference)
        for (size_t test = 0; test < results.series.size(); ++test) {
            if (test == reference) continue;
            for (const SweepResults::Row& row : results.meshes)
                list.push_back(entry(row.name, reference, test,
                                     bjontegaard(ratePoints(row, reference), ratePoints(row, test))));
            const MeanBjontegaard mean = meanBjontegaard(results, reference, test);
            list.push_back(entry(nullptr, reference, test, mean.mean)); // null: the mean over the meshes
            list.back()["rate_meshes"] = mean.rateMeshes;
            list.back()["psnr_meshes"] = mean.psnrMeshes;
        }
    return list;
}

// A whole point without what the mesh's own entry says.
Json pointJson(const Point& point)
{
    Json json = toJson(point);
    for (const char* key : {"sha256", "reference_faces", "diagonal", "note", "samples", "versions"})
        json.erase(key);
    return json;
}

void addVersions(Json& into, const Json& versions)
{
    for (const auto& [package, version] : versions.items()) {
        Json& known = into[package];
        if (known.is_null()) known = Json::array();
        if (std::find(known.begin(), known.end(), version) == known.end()) known.push_back(version);
    }
}

SweepResults emptyResults(const SweepPlan& plan, const std::vector<std::string>& hashes)
{
    SweepResults results;
    results.sizes = plan.sizes;
    for (const Series& series : plan.series)
        results.series.push_back({series.id, series.label, plan.coders[series.coder].ours});
    for (size_t m = 0; m < plan.meshes.size(); ++m) {
        SweepResults::Row row{plan.meshes[m].name, hashes[m], "", 0, 0, {}};
        row.points.assign(plan.series.size(), std::vector<std::optional<Point>>(plan.sizes.size()));
        results.meshes.push_back(std::move(row));
    }
    return results;
}

void takePoint(SweepResults& results, const Job& job, size_t size, Point point)
{
    SweepResults::Row& row = results.meshes[job.mesh];
    if (point.referenceFaces > 0) {
        row.faces = point.referenceFaces;
        row.diagonal = point.diagonal;
        row.note = point.note;
    }
    addVersions(results.series[job.series].versions, point.versions);
    row.points[job.series][size] = std::move(point);
}

void dropSeries(SweepResults& results, size_t series)
{
    const auto at = static_cast<std::ptrdiff_t>(series);
    results.series.erase(results.series.begin() + at);
    for (SweepResults::Row& row : results.meshes) row.points.erase(row.points.begin() + at);
}

} // namespace

SweepResults collectResults(const SweepPlan& plan, const std::vector<size_t>& jobs,
                            const std::vector<std::string>& hashes, const SweepFolder& folder, int samples)
{
    SweepResults results = emptyResults(plan, hashes);
    results.samples = samples;
    std::vector<bool> isUsed(plan.series.size());
    for (const size_t index : jobs) {
        const Job& job = plan.jobs[index];
        for (size_t s = 0; s < plan.sizes.size(); ++s) {
            std::optional<Point> point =
                storedPoint(folder, plan, job, plan.sizes[s], hashes[job.mesh], samples);
            if (!point) continue;
            isUsed[job.series] = true;
            takePoint(results, job, s, std::move(*point));
        }
    }
    for (size_t i = plan.series.size(); i-- > 0;)
        if (!isUsed[i]) dropSeries(results, i);
    return results;
}

std::vector<RatePoint> ratePoints(const SweepResults::Row& row, size_t series)
{
    std::vector<RatePoint> points;
    for (const std::optional<Point>& p : row.points[series])
        if (p && p->state == State::Done)
            points.push_back({static_cast<double>(p->bytes), p->distance.psnr()});
    return points;
}

MeanBjontegaard meanBjontegaard(const SweepResults& results, size_t reference, size_t test)
{
    MeanBjontegaard mean;
    double rate = 0, psnr = 0;
    for (const SweepResults::Row& row : results.meshes) {
        const Bjontegaard delta = bjontegaard(ratePoints(row, reference), ratePoints(row, test));
        if (delta.ratePercent) rate += *delta.ratePercent, ++mean.rateMeshes;
        if (delta.psnr) psnr += *delta.psnr, ++mean.psnrMeshes;
    }
    if (mean.rateMeshes > 0) mean.mean.ratePercent = rate / mean.rateMeshes;
    if (mean.psnrMeshes > 0) mean.mean.psnr = psnr / mean.psnrMeshes;
    return mean;
}

MeanCurves meanCurves(const SweepResults& results)
{
    const auto psnr = [&](size_t mesh, size_t series, size_t size) -> std::optional<double> {
        const std::optional<Point>& p = results.meshes[mesh].points[series][size];
        if (!p || p->state != State::Done || !std::isfinite(p->distance.psnr())) return std::nullopt;
        return p->distance.psnr();
    };
    std::vector<bool> counts(results.series.size());
    for (size_t c = 0; c < counts.size(); ++c)
        for (size_t m = 0; m < results.meshes.size(); ++m)
            for (size_t s = 0; s < results.sizes.size(); ++s)
                if (psnr(m, c, s)) counts[c] = true;
    MeanCurves curves;
    curves.meshes.assign(results.sizes.size(), 0);
    curves.psnr.assign(counts.size(), std::vector<double>(results.sizes.size(), 0));
    for (size_t s = 0; s < results.sizes.size(); ++s) {
        for (size_t m = 0; m < results.meshes.size(); ++m) {
            bool whole = true;
            for (size_t c = 0; c < counts.size(); ++c) whole = whole && (!counts[c] || psnr(m, c, s));
            if (!whole) continue;
            ++curves.meshes[s];
            for (size_t c = 0; c < counts.size(); ++c)
                if (counts[c]) curves.psnr[c][s] += *psnr(m, c, s);
        }
        for (size_t c = 0; c < counts.size(); ++c)
            curves.psnr[c][s] = counts[c] && curves.meshes[s] > 0 ? curves.psnr[c][s] / curves.meshes[s]
                                                                  : std::numeric_limits<double>::quiet_NaN();
    }
    return curves;
}

bool anyFailed(const SweepResults& results)
{
    for (const SweepResults::Row& row : results.meshes)
        for (const auto& series : row.points)
            for (const std::optional<Point>& p : series)
                if (p && p->state == State::Failed) return true;
    return false;
}

std::string resultsCsv(const SweepResults& results)
{
    std::string csv =
        "mesh,coder,grid,target,state,bytes,psnr,rms_ref_to_test,rms_test_to_ref,"
        "max_ref_to_test,max_test_to_ref,hausdorff,normal_error_degrees,faces,settings,message\n";
    for (const SweepResults::Row& row : results.meshes)
        for (const auto& series : row.points)
            for (const std::optional<Point>& p : series)
                if (p) csv += csvLine(*p);
    return csv;
}

Json resultsJson(const SweepResults& results)
{
    Json json;
    json["command"] = results.command;
    json["samples"] = results.samples;
    json["sizes"] = results.sizes;
    json["series"] = Json::array();
    for (const SweepResults::Column& series : results.series)
        json["series"].push_back({{"id", series.id},
                                  {"label", series.label},
                                  {"side", series.ours ? "ours" : "peer"},
                                  {"versions", series.versions}});
    json["skipped"] = Json::array();
    for (const Absence& absence : results.skipped)
        json["skipped"].push_back({{"coder", absence.coder}, {"packages", absence.packages}});
    json["broken"] = results.broken;
    json["meshes"] = Json::array();
    json["points"] = Json::array();
    for (const SweepResults::Row& row : results.meshes) {
        json["meshes"].push_back({{"name", row.name},
                                  {"sha256", row.sha256},
                                  {"faces", row.faces},
                                  {"diagonal", row.diagonal},
                                  {"note", row.note}});
        for (const auto& series : row.points)
            for (const std::optional<Point>& p : series)
                if (p) json["points"].push_back(pointJson(*p));
    }
    json["bjontegaard"] = bjontegaardJson(results);
    return json;
}

} // namespace gimg::gimrd

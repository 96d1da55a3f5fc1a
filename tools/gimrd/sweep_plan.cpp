#include "sweep_plan.h"

#include "gimg/image_io.h"

#include <algorithm>
#include <map>
#include <set>

namespace gimg::gimrd {
namespace {

Error badArgument(std::string message) { return {ErrorKind::BadArgument, std::move(message)}; }

template <class T> std::vector<T> sorted(std::vector<T> list)
{
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

Result<std::vector<SweepMesh>> planMeshes(const SweepRequest& request)
{
    std::map<std::string, SweepMesh> byName;
    for (const std::filesystem::path& path : request.meshes) {
        SweepMesh mesh{path, path.stem().string()};
        std::error_code failed;
        const std::uintmax_t bytes = std::filesystem::file_size(path, failed);
        if (!failed) mesh.bytes = bytes;
        if (isGridImage(path)) mesh.imageSide = sideOfF32(path.string());
        const auto [place, isNew] = byName.emplace(mesh.name, mesh);
        if (!isNew)
            return badArgument(place->second.path.string() + " and " + path.string() +
                               " would both be called " + mesh.name + "; rename one");
    }
    std::vector<SweepMesh> meshes;
    for (auto& [name, mesh] : byName) meshes.push_back(std::move(mesh));
    return meshes;
}

// Whether a coder is asked for; an unknown name is found by checkNames().
bool isChosen(const CoderProgram& coder, const SweepRequest& request)
{
    const auto& names = coder.ours ? request.ours : request.peers;
    return !names || std::find(names->begin(), names->end(), coder.name) != names->end();
}

Status checkNames(const std::vector<std::string>& names, bool ours, const std::vector<CoderProgram>& coders)
{
    std::string known;
    std::set<std::string> set{"none"};
    for (const CoderProgram& coder : coders) {
        if (coder.ours != ours) continue;
        known += (known.empty() ? "" : ", ") + coder.name;
        set.insert(coder.name);
    }
    for (const std::string& name : names)
        if (!set.contains(name))
            return badArgument(std::string(ours ? "--coders: " : "--peers: ") + "no coder is called '" +
                               name + "'; there are " + (known.empty() ? "none" : known));
    if (names.size() > 1 && std::find(names.begin(), names.end(), "none") != names.end())
        return badArgument("'none' stands alone");
    return Done{};
}

// The grids at which a coder runs on a mesh.
std::vector<int> gridsOf(const CoderProgram& coder, const SweepMesh& mesh, const SweepRequest& request)
{
    if (coder.takesImage && isGridImage(mesh.path)) return {mesh.imageSide > 0 ? mesh.imageSide : kImageGrid};
    if (!coder.takesImage && !coder.usesGrid) return {0};
    if (request.grids.empty()) return {coder.takesImage ? kImageGrid : 0};
    std::vector<int> grids = request.grids;
    if (coder.takesImage) std::replace(grids.begin(), grids.end(), 0, kImageGrid);
    return sorted(grids);
}

Series makeSeries(const std::vector<CoderProgram>& coders, size_t coder, int grid, bool several)
{
    Series series{coder, grid, coders[coder].name, coders[coder].title};
    if (grid != 0) series.id += '-' + std::to_string(grid);
    if (several) series.label += grid == 0 ? ", automatic grid" : ", grid " + std::to_string(grid);
    return series;
}

} // namespace

Result<SweepPlan> planSweep(const SweepRequest& request, const std::vector<CoderProgram>& coders)
{
    SweepPlan plan;
    for (const bool ours : {true, false}) {
        const auto& names = ours ? request.ours : request.peers;
        if (!names) continue;
        const Status known = checkNames(*names, ours, coders);
        if (!known) return known.error();
        plan.named.insert(plan.named.end(), names->begin(), names->end());
    }
    for (const CoderProgram& coder : coders)
        if (isChosen(coder, request)) plan.coders.push_back(coder);
    if (plan.coders.empty()) return badArgument("no coder is left to run");
    Result<std::vector<SweepMesh>> meshes = planMeshes(request);
    if (!meshes) return meshes.error();
    plan.meshes = std::move(*meshes);
    plan.sizes = sorted(request.sizes);

    std::set<std::string> ids;
    std::map<std::pair<size_t, int>, size_t> seriesOf;
    for (size_t c = 0; c < plan.coders.size(); ++c) {
        std::set<int> grids;
        for (const SweepMesh& mesh : plan.meshes)
            for (const int grid : gridsOf(plan.coders[c], mesh, request)) grids.insert(grid);
        for (const int grid : grids) {
            seriesOf[{c, grid}] = plan.series.size();
            plan.series.push_back(makeSeries(plan.coders, c, grid, grids.size() > 1));
            if (!ids.insert(plan.series.back().id).second)
                return badArgument("two coders would write files called " + plan.series.back().id);
        }
    }
    for (size_t m = 0; m < plan.meshes.size(); ++m)
        for (size_t c = 0; c < plan.coders.size(); ++c)
            for (const int grid : gridsOf(plan.coders[c], plan.meshes[m], request))
                plan.jobs.push_back({m, seriesOf.at({c, grid})});
    return plan;
}

bool isGridImage(const std::filesystem::path& path) { return path.extension() == ".f32"; }

} // namespace gimg::gimrd

#include "gimg/disk.h"
#include "gimg/global_parameterization.h"

#include <algorithm>
#include <string>

namespace gimg {
namespace {

// From the first face across its edges to all others, breadth first.
std::vector<Vec2> integrate(const Mesh& disk, const ComplexOneForm& form)
{
    const Halfedges he(disk.faces, disk.vertexCount());
    std::vector<Vec2> uv(disk.positions.size(), Vec2::Zero());
    std::vector<bool> known(disk.positions.size(), false), seen(disk.faces.size(), false);
    std::vector<int> faces = {0};
    seen[0] = known[disk.faces[0][0]] = true;
    for (size_t i = 0; i < faces.size(); ++i) {
        const int f = faces[i];
        int h = 3 * f;
        while (!known[he.tail(h)]) ++h;
        for (int k = 0; k < 3; ++k, h = Halfedges::next(h)) {
            if (!known[he.head(h)]) {
                uv[he.head(h)] = uv[he.tail(h)] + Vec2(form[h].real(), form[h].imag());
                known[he.head(h)] = true;
            }
            if (he.onBoundary(h) || seen[he.twin(h) / 3]) continue;
            seen[he.twin(h) / 3] = true;
            faces.push_back(he.twin(h) / 3);
        }
    }
    return uv;
}

double diameterOf(const std::vector<Vec2>& uv)
{
    Vec2 low = uv[0], high = uv[0];
    for (const Vec2& p : uv) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    return (high - low).norm();
}

void measureJumps(const DiskMesh& disk, PlaneMap& plane)
{
    const size_t paths = plane.cut.paths.size();
    std::vector<const DiskSide*> along(paths, nullptr), against(paths, nullptr);
    for (const DiskSide& side : disk.sides) (side.reversed ? against : along)[side.path] = &side;
    plane.jumps.assign(paths, 0);
    const std::vector<Vec2>& uv = plane.map.uv;
    for (size_t p = 0; p < paths; ++p) {
        if (!along[p] || !against[p]) continue;
        // The disk lies to the left of each of its sides.
        const std::vector<int>&left = along[p]->vertices, &right = against[p]->vertices;
        const auto jump = [&](size_t i) -> Vec2 { return uv[right[right.size() - 1 - i]] - uv[left[i]]; };
        Vec2 mean = Vec2::Zero();
        for (size_t i = 0; i < left.size(); ++i) mean += jump(i) / static_cast<double>(left.size());
        for (size_t i = 0; i < left.size(); ++i)
            plane.jumpError = std::max(plane.jumpError, (jump(i) - mean).norm());
        plane.jumps[p] = {mean[0], mean[1]};
    }
    const double diameter = diameterOf(uv);
    if (diameter > 0) plane.jumpError /= diameter;
}

} // namespace

Result<PlaneMap> integrateOverDisk(const Mesh& mesh, const ComplexOneForm& form)
{
    if (form.size() != 3 * static_cast<Eigen::Index>(mesh.faceCount()))
        return Error{ErrorKind::BadArgument, std::to_string(form.size()) + " numbers of a 1-form for " +
                                                 std::to_string(mesh.faceCount()) + " faces"};
    PlaneMap plane;
    plane.cut = cutToDisk(mesh);
    const Result<DiskMesh> disk = openAlong(mesh, plane.cut);
    if (!disk) return disk.error();
    plane.map.uv = integrate(disk->mesh, form);
    plane.map.corners = disk->mesh.faces;
    measureJumps(*disk, plane);
    return plane;
}

} // namespace gimg

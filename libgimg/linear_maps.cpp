#include "gimg/linear_maps.h"

#include "convex_combination.h"
#include "gimg/intrinsic.h"
#include "gimg/mean_value.h"
#include "gimg/stretch.h"

#include <string>

namespace gimg {
namespace {

void addBothWays(std::vector<MeanWeight>& weights, int v, int w, double weight)
{
    weights.push_back({v, w, weight});
    weights.push_back({w, v, weight});
}

Status tutteMap(const Mesh& mesh, const std::vector<bool>& fixed, std::vector<Vec2>& position)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::vector<MeanWeight> weights;
    for (int h = 0; h < he.count(); ++h)
        if (h > he.twin(h)) addBothWays(weights, he.tail(h), he.head(h), 1);
    return placeAtMeans(weights, Weights::Symmetric, fixed, position);
}

Status harmonicMap(const Mesh& mesh, const std::vector<bool>& fixed, std::vector<Vec2>& position)
{
    Result<IntrinsicTriangulation> delaunay = IntrinsicTriangulation::of(mesh);
    if (!delaunay) return delaunay.error();
    delaunay->makeDelaunay();
    std::vector<MeanWeight> weights;
    for (int h = 0; h < delaunay->halfedgeCount(); ++h)
        if (h > delaunay->twin(h))
            addBothWays(weights, delaunay->tail(h), delaunay->head(h), delaunay->weight(h));
    return placeAtMeans(weights, Weights::Symmetric, fixed, position);
}

} // namespace

const char* mapName(MapKind kind)
{
    switch (kind) {
    case MapKind::MeanValue:
        return "mvc";
    case MapKind::Tutte:
        return "tutte";
    case MapKind::Harmonic:
        return "harmonic";
    case MapKind::Conformal:
        return "conformal";
    case MapKind::Stretch:
        break;
    }
    return "stretch";
}

Result<std::vector<Vec2>> linearMap(const SquareDisk& square, MapKind kind)
{
    const Mesh& disk = square.disk.mesh;
    std::vector<bool> fixed;
    for (uint8_t sides : square.squareSides) fixed.push_back(sides != 0);
    std::vector<Vec2> st = square.borderPosition;
    Status mapped = Error{ErrorKind::BadArgument,
                          std::string("the ") + mapName(kind) + " map is no linear map of a disk"};
    if (kind == MapKind::MeanValue) mapped = meanValueMap(disk, fixed, st);
    if (kind == MapKind::Tutte) mapped = tutteMap(disk, fixed, st);
    if (kind == MapKind::Harmonic) mapped = harmonicMap(disk, fixed, st);
    if (!mapped) return mapped.error();
    return st;
}

Result<Parameterization> mapToSquare(const SquareDisk& square, MapKind kind, const Progress& progress,
                                     Density density)
{
    if (progress) progress(0);
    if (kind == MapKind::Stretch) return flattenToSquare(square, progress, density);
    Result<std::vector<Vec2>> st = linearMap(square, kind);
    if (!st) return st.error();
    if (const int flipped = flippedTriangles(square.disk.mesh.faces, *st); flipped > 0)
        return Error{ErrorKind::FlippedTriangle,
                     std::to_string(flipped) + " of " + std::to_string(square.disk.mesh.faceCount()) +
                         " triangles of the " + mapName(kind) + " map are flipped or have no area"};
    if (progress) progress(1);
    const double efficiency = stretchEfficiency(square.disk.mesh, *st);
    return Parameterization{std::move(*st), efficiency};
}

} // namespace gimg

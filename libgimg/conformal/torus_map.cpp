#include "gimg/torus_map.h"

#include "conformal/handle_tori.h"
#include "gimg/global_parameterization.h"
#include "gimg/stretch.h"

#include <algorithm>
#include <string>

namespace gimg {
namespace {

constexpr int kLowest = 33;

// Two loops along mesh edges, opened to a square: the word is a b a' b'.
Result<SquareDisk> openSquare(const Mesh& mesh, const ComplexOneForm& form, const BorderOptions& options)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    const Result<CrossingLoops> loops = crossingLoops(mesh, he, form);
    if (!loops) return loops.error();
    CutGraph cut;
    for (const Loop* loop : {&loops->a, &loops->b}) {
        cut.paths.emplace_back();
        for (int h : loop->halfedges) cut.paths.back().vertices.push_back(he.tail(h));
        cut.paths.back().vertices.push_back(cut.paths.back().vertices.front());
    }
    const int grid = options.grid != 0 ? options.grid : std::max(BorderOptions::kDefaultGrid, options.lowest);
    BorderLayout layout;
    layout.lowest = options.lowest != 0 ? options.lowest : std::min(kLowest, grid);
    layout.pathLength = {layout.lowest - 1, layout.lowest - 1};
    return layOutBorder(mesh, cut, layout, grid);
}

// The form added up over the disk, from the square's corner (0, 0) on.
std::vector<std::complex<double>> integrated(const SquareDisk& square, const ComplexOneForm& form)
{
    const Mesh& disk = square.disk.mesh;
    const Halfedges he(disk.faces, disk.vertexCount());
    std::vector<std::complex<double>> z(disk.positions.size());
    std::vector<bool> known(disk.positions.size(), false);
    std::vector<int> vertices = {square.disk.sides[0].vertices[0]};
    known[vertices[0]] = true;
    for (size_t i = 0; i < vertices.size(); ++i) {
        const int v = vertices[i];
        const auto reach = [&](int w, std::complex<double> along) {
            if (known[w]) return;
            known[w] = true;
            z[w] = z[v] + along;
            vertices.push_back(w);
        };
        for (int h = he.outgoing(v), first = h;;) {
            reach(he.head(h), form[h]);
            const int before = Halfedges::prev(h); // its tail is a neighbour, the last one on the border
            reach(he.tail(before), -form[before]);
            h = he.rotateCcw(h);
            if (h < 0 || h == first) break;
        }
    }
    return z;
}

} // namespace

Result<TorusMap> torusToSquare(const Mesh& mesh, const BorderOptions& options)
{
    const Topology type = topology(mesh);
    if (type.boundaries > 0) return Error{ErrorKind::NotClosed, "a torus has no boundary"};
    if (type.genus != 1)
        return Error{ErrorKind::WrongGenus,
                     "a torus has genus 1, this surface has genus " + std::to_string(type.genus)};
    const Result<SurfaceForms> coarse = surfaceForms(mesh);
    if (!coarse) return coarse.error();
    Result<SquareDisk> square = openSquare(mesh, coarse->basis[0], options);
    if (!square) return square.error();
    // The layout may have split some edges.
    const Result<SurfaceForms> forms = surfaceForms(square->surface);
    if (!forms) return forms.error();
    const std::vector<std::complex<double>> z = integrated(*square, forms->basis[0]);

    const std::vector<DiskSide>& sides = square->disk.sides;
    const std::complex<double> bottom = z[sides[0].vertices.back()], left = z[sides[3].vertices.front()];
    Eigen::Matrix2d parallelogram;
    parallelogram << bottom.real(), left.real(), bottom.imag(), left.imag();
    const Eigen::Matrix2d toSquare = parallelogram.inverse();
    TorusMap torus;
    torus.tau = left / bottom;
    for (const std::complex<double>& w : z) torus.map.st.push_back(toSquare * Vec2(w.real(), w.imag()));
    torus.map.efficiency = stretchEfficiency(square->disk.mesh, torus.map.st);
    torus.square = std::move(*square);
    const int flipped = flippedTriangles(torus.square.disk.mesh.faces, torus.map.st);
    if (flipped > 0)
        return Error{ErrorKind::FlippedTriangle,
                     std::to_string(flipped) + " triangles are flipped or have no area in the plane"};
    return torus;
}

} // namespace gimg

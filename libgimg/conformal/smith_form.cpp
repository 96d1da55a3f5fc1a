#include "gimg/homology.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

namespace gimg {
namespace {

// Rows are what is added to each other most.
using Integers = Eigen::Matrix<int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int64_t kLargest = int64_t{1} << 31; // products fit 64 bits

/// The boundary matrices of a complex: d1 from edges to vertices, d2 from faces to edges.
struct Boundaries
{
    std::vector<std::array<int, 2>> edges;
    Integers d1, d2;
};

Boundaries boundariesOf(const std::vector<Triangle>& faces, int vertexCount)
{
    Boundaries result;
    for (const Triangle& t : faces)
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
            result.edges.push_back({low, high});
        }
    std::sort(result.edges.begin(), result.edges.end());
    result.edges.erase(std::unique(result.edges.begin(), result.edges.end()), result.edges.end());
    const Eigen::Index edges = static_cast<Eigen::Index>(result.edges.size());
    result.d1 = Integers::Zero(vertexCount, edges);
    for (Eigen::Index e = 0; e < edges; ++e) {
        result.d1(result.edges[e][0], e) = -1;
        result.d1(result.edges[e][1], e) = 1;
    }
    result.d2 = Integers::Zero(edges, static_cast<Eigen::Index>(faces.size()));
    for (size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = faces[f][k], b = faces[f][(k + 1) % 3];
            const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
            const auto place = std::lower_bound(result.edges.begin(), result.edges.end(), edge);
            result.d2(place - result.edges.begin(), static_cast<Eigen::Index>(f)) += a < b ? 1 : -1;
        }
    return result;
}

/// A change of the basis of chains that edges are given in: column operations on what edges are mapped to and
/// on the basis, and the inverse row operations on what is mapped to edges.
struct EdgeBasis
{
    Integers image;   ///< edges to vertices, transposed: a row an edge
    Integers basis;   ///< a row a chain
    Integers content; ///< faces to edges: a row an edge

    void swap(Eigen::Index i, Eigen::Index j)
    {
        for (Integers* m : {&image, &basis, &content})
            if (m->rows() > 0) m->row(i).swap(m->row(j));
    }
    void addTimes(Eigen::Index to, Eigen::Index from, int64_t times)
    {
        if (image.rows() > 0) image.row(to) += times * image.row(from);
        basis.row(to) += times * basis.row(from);
        content.row(from) -= times * content.row(to);
    }
};

bool isTooLarge(const Integers& m) { return m.size() > 0 && m.cwiseAbs().maxCoeff() > kLargest; }

// Brings d1 to echelon form and returns its rank: later chains are cycles.
Eigen::Index separateCycles(EdgeBasis& chains)
{
    Eigen::Index rank = 0;
    const Eigen::Index edges = chains.image.rows();
    for (Eigen::Index v = 0; v < chains.image.cols(); ++v) {
        for (Eigen::Index e = rank; e < edges; ++e) {
            if (chains.image(e, v) == 0) continue;
            // Entries stay 0 and +-1: a matrix of a graph is totally unimodular.
            chains.swap(rank, e);
            for (Eigen::Index other = e + 1; other < edges; ++other)
                if (chains.image(other, v) != 0)
                    chains.addTimes(other, rank, -chains.image(other, v) / chains.image(rank, v));
            ++rank;
            break;
        }
    }
    return rank;
}

struct Place
{
    Eigen::Index row, column;
};

std::optional<Place> leastEntry(const Integers& m, Eigen::Index begin)
{
    std::optional<Place> least;
    for (Eigen::Index i = begin; i < m.rows(); ++i)
        for (Eigen::Index j = begin; j < m.cols(); ++j) {
            const int64_t entry = std::abs(m(i, j));
            if (entry == 0 || (least && entry >= std::abs(m(least->row, least->column)))) continue;
            least = {i, j};
            if (entry == 1) return least;
        }
    return least;
}

std::optional<Place> indivisible(const Integers& m, Eigen::Index k)
{
    if (std::abs(m(k, k)) == 1) return std::nullopt;
    for (Eigen::Index i = k + 1; i < m.rows(); ++i)
        for (Eigen::Index j = k + 1; j < m.cols(); ++j)
            if (m(i, j) % m(k, k) != 0) return Place{i, j};
    return std::nullopt;
}

// Smith's normal form of the faces in the basis of cycles, which is changed along. Returns the diagonal, or
// nothing where numbers became too large.
std::optional<std::vector<int64_t>> smithDiagonal(EdgeBasis& cycles)
{
    Integers& m = cycles.content;
    std::vector<int64_t> diagonal;
    for (Eigen::Index k = 0; k < std::min(m.rows(), m.cols()); ++k) {
        for (;;) {
            const std::optional<Place> least = leastEntry(m, k);
            if (!least) return diagonal;
            cycles.swap(k, least->row);
            m.col(k).swap(m.col(least->column));
            for (Eigen::Index i = k + 1; i < m.rows(); ++i)
                if (m(i, k) != 0) cycles.addTimes(k, i, m(i, k) / m(k, k));
            for (Eigen::Index j = k + 1; j < m.cols(); ++j) {
                const int64_t times = m(k, j) / m(k, k);
                if (times != 0) m.col(j) -= times * m.col(k);
            }
            if (isTooLarge(m) || isTooLarge(cycles.basis)) return std::nullopt;
            if (!m.col(k).tail(m.rows() - k - 1).isZero() || !m.row(k).tail(m.cols() - k - 1).isZero())
                continue;
            const std::optional<Place> bad = indivisible(m, k);
            if (!bad) break;
            m.col(k) += m.col(bad->column);
        }
        diagonal.push_back(std::abs(m(k, k)));
    }
    return diagonal;
}

} // namespace

Result<SimplicialHomology> homologyBySmithForm(const std::vector<Triangle>& faces, int vertexCount)
{
    if (faces.empty()) return Error{ErrorKind::EmptyMesh, "the complex has no faces"};
    for (size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k)
            if (faces[f][k] < 0 || faces[f][k] >= vertexCount || faces[f][k] == faces[f][(k + 1) % 3])
                return Error{ErrorKind::BadArgument,
                             "face " + std::to_string(f) + " names a vertex twice or one that is not there"};
    Boundaries boundaries = boundariesOf(faces, vertexCount);
    const Eigen::Index edges = boundaries.d2.rows();
    EdgeBasis chains{boundaries.d1.transpose(), Integers::Identity(edges, edges), std::move(boundaries.d2)};
    const Eigen::Index rank = separateCycles(chains);
    EdgeBasis cycles{{}, chains.basis.bottomRows(edges - rank), chains.content.bottomRows(edges - rank)};
    const std::optional<std::vector<int64_t>> diagonal = smithDiagonal(cycles);
    if (!diagonal) return Error{ErrorKind::BadArgument, "the numbers of the Smith form grow too large"};

    SimplicialHomology homology;
    homology.edges = std::move(boundaries.edges);
    for (const int64_t order : *diagonal)
        if (order > 1) homology.torsion.push_back(static_cast<int>(order));
    const Eigen::Index bounding = static_cast<Eigen::Index>(diagonal->size());
    homology.rank = static_cast<int>(cycles.basis.rows() - bounding);
    for (Eigen::Index i = bounding; i < cycles.basis.rows(); ++i)
        homology.cycles.push_back(cycles.basis.row(i).cast<int>().transpose());
    return homology;
}

} // namespace gimg

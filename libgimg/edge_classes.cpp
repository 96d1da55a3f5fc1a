#include "edge_classes.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <queue>

namespace gimg {
namespace {

// Shortest paths from vertex 0: where they meet behind a handle they soon run together again, so that few
// edges far from handles have a class.
std::vector<bool> treeEdges(const EditableSurface& surface)
{
    std::vector<double> distance(static_cast<size_t>(surface.vertexCount()),
                                 std::numeric_limits<double>::infinity());
    std::vector<int> entry(distance.size(), -1);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    const int root = surface.tail(0);
    distance[root] = 0;
    queue.push({0.0, root});
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > distance[v]) continue;
        surface.forEachEdgeAt(v, [&, from = d](int h, int w) {
            const double through = from + surface.length(h);
            if (through >= distance[w]) return;
            distance[w] = through;
            entry[w] = h;
            queue.push({through, w});
        });
    }
    std::vector<bool> inTree(static_cast<size_t>(surface.halfedgeCount()), false);
    for (int h : entry) {
        if (h < 0) continue;
        inTree[h] = true;
        if (surface.twin(h) >= 0) inTree[surface.twin(h)] = true;
    }
    return inTree;
}

// The dual graph without the tree: nodes are faces and, behind them, boundary loops.
class Cotree
{
public:
    explicit Cotree(const EditableSurface& surface)
        : surface_(surface), inTree_(treeEdges(surface)), faces_(surface.halfedgeCount() / 3)
    {
        nameBoundaries();
        span();
    }

    // Edges in neither tree: two for each handle.
    const std::vector<int>& leftOver() const { return leftOver_; }
    const std::vector<int>& order() const { return order_; } ///< nodes, parents first
    int node(int h) const { return h < 0 ? -1 : h / 3; }
    int across(int h) const { return surface_.twin(h) >= 0 ? surface_.twin(h) / 3 : boundary_.at(h); }
    int entry(int n) const { return entry_[n]; }   ///< the halfedge that is crossed from the parent
    int parent(int n) const { return parent_[n]; } ///< -1 for the root

private:
    void nameBoundaries()
    {
        int loops = 0;
        std::map<int, int> leaving; // boundary vertex -> its boundary halfedge
        for (int h = 0; h < surface_.halfedgeCount(); ++h)
            if (surface_.twin(h) < 0) leaving[surface_.tail(h)] = h;
        for (const auto& [v, start] : leaving) {
            if (boundary_.count(start)) continue;
            for (int h = start; boundary_.emplace(h, faces_ + loops).second;)
                h = leaving.at(surface_.head(h));
            loopEdges_.emplace_back();
            ++loops;
        }
        for (const auto& [h, n] : boundary_) loopEdges_[n - faces_].push_back(h);
    }

    template <class Visit> void forEachEdgeOf(int n, Visit visit) const
    {
        if (n < faces_)
            for (int h = 3 * n; h < 3 * n + 3; ++h) visit(h, across(h));
        else
            for (int h : loopEdges_[n - faces_]) visit(h, h / 3);
    }

    void span()
    {
        const size_t nodes = static_cast<size_t>(faces_) + loopEdges_.size();
        entry_.assign(nodes, -1);
        parent_.assign(nodes, -1);
        std::vector<bool> seen(nodes, false);
        std::vector<bool> used = inTree_;
        seen[0] = true;
        order_.push_back(0);
        for (size_t at = 0; at < order_.size(); ++at) {
            const int n = order_[at];
            forEachEdgeOf(n, [&](int h, int m) {
                if (used[h] || seen[m]) return;
                seen[m] = used[h] = true;
                if (surface_.twin(h) >= 0) used[surface_.twin(h)] = true;
                entry_[m] = h;
                parent_[m] = n;
                order_.push_back(m);
            });
        }
        for (int h = 0; h < surface_.halfedgeCount(); ++h)
            if (!used[h] && (surface_.twin(h) < 0 || h < surface_.twin(h))) leftOver_.push_back(h);
    }

    const EditableSurface& surface_;
    const std::vector<bool> inTree_;
    const int faces_;
    std::map<int, int> boundary_; // boundary halfedge -> node of its loop
    std::vector<std::vector<int>> loopEdges_;
    std::vector<int> entry_, parent_, order_, leftOver_;
};

HomologyClass sum(HomologyClass a, const HomologyClass& b)
{
    for (size_t i = 0; i < a.size(); ++i) a[i] ^= b[i];
    return a;
}

bool isNothing(const HomologyClass& a)
{
    return std::all_of(a.begin(), a.end(), [](uint64_t word) { return word == 0; });
}

} // namespace

EdgeClasses::EdgeClasses(const EditableSurface& surface)
    : row_(static_cast<size_t>(surface.halfedgeCount()), 0)
{
    const Cotree cotree(surface);
    genus_ = static_cast<int>(cotree.leftOver().size() / 2);
    words_ = std::max<size_t>(1, (cotree.leftOver().size() + 63) / 64);
    table_.assign(words_, 0);

    // The i-th cocycle is 1 on the edges that one dual cycle crosses: the i-th edge left over, then within
    // the cotree back to its other side. So a cotree edge has those i with one end below it.
    std::map<HomologyClass, int> rows{{HomologyClass(words_, 0), 0}};
    const auto row = [&](const HomologyClass& value) {
        const auto [found, isNew] = rows.emplace(value, static_cast<int>(rows.size()));
        if (isNew) table_.insert(table_.end(), value.begin(), value.end());
        return found->second;
    };
    const auto valueOf = [&](int r) {
        const auto first = table_.begin() + static_cast<std::ptrdiff_t>(static_cast<size_t>(r) * words_);
        return HomologyClass(first, first + static_cast<std::ptrdiff_t>(words_));
    };
    const auto set = [&](int h, int r) {
        row_[h] = r;
        if (surface.twin(h) >= 0) row_[surface.twin(h)] = r;
    };
    std::vector<int> below(cotree.order().size(), 0); // per node: a row, the sum over its subtree
    const auto include = [&](int n, int r) {
        if (r != 0) below[n] = below[n] == 0 ? r : row(sum(valueOf(below[n]), valueOf(r)));
    };
    for (size_t i = 0; i < cotree.leftOver().size(); ++i) {
        const int h = cotree.leftOver()[i];
        HomologyClass bit(words_, 0);
        bit[i / 64] = uint64_t{1} << (i % 64);
        const int r = row(bit);
        set(h, r);
        include(cotree.node(h), r);
        include(cotree.across(h), r);
    }
    for (size_t at = cotree.order().size(); at-- > 1;) {
        const int n = cotree.order()[at];
        set(cotree.entry(n), below[n]);
        include(cotree.parent(n), below[n]);
    }
}

bool EdgeClasses::isZero(int h) const
{
    const uint64_t* row = &table_[static_cast<size_t>(row_[h]) * words_];
    return std::all_of(row, row + words_, [](uint64_t word) { return word == 0; });
}

// Functionals that vanish on the loop: one that does not, the pivot, is added to all others that do not, and
// is itself given up.
void EdgeClasses::divideBy(const HomologyClass& loop)
{
    size_t word = 0;
    while (loop[word] == 0) ++word;
    const uint64_t pivot = uint64_t{1} << std::countr_zero(loop[word]);
    for (size_t row = 0; row < table_.size(); row += words_)
        if (table_[row + word] & pivot)
            for (size_t i = 0; i < words_; ++i) table_[row + i] ^= loop[i];
}

int EdgeClasses::rowOf(const HomologyClass& value)
{
    if (isNothing(value)) return 0;
    table_.insert(table_.end(), value.begin(), value.end());
    return static_cast<int>(table_.size() / words_) - 1;
}

void EdgeClasses::append(const HomologyClass& a, const HomologyClass& b, const HomologyClass& c)
{
    for (const HomologyClass* value : {&a, &b, &c}) row_.push_back(rowOf(*value));
}

} // namespace gimg

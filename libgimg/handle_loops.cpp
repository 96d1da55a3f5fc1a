#include "handle_loops.h"

#include <algorithm>
#include <limits>

namespace gimg {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double meanEdgeLength(const EditableSurface& surface)
{
    double sum = 0;
    for (int h = 0; h < surface.halfedgeCount(); ++h) sum += surface.length(h);
    return sum / surface.halfedgeCount();
}

} // namespace

HandleLoops::HandleLoops(const EditableSurface& surface, const EdgeClasses& classes)
    : surface_(surface), classes_(classes), firstRadius_(4 * meanEdgeLength(surface)), sum_(classes.words())
{
    grow();
    for (int h = 0; h < surface.halfedgeCount(); ++h)
        if (!classes.isZero(h) && bound_[surface.head(h)] < 0 && bound_[surface.tail(h)] < 0)
            addRoot(surface.tail(h));
}

void HandleLoops::grow()
{
    bound_.resize(static_cast<size_t>(surface_.vertexCount()), -1.0);
    slot_.resize(bound_.size(), -1);
}

void HandleLoops::addRoot(int v)
{
    grow();
    bound_[v] = 0;
    roots_.push({0.0, v});
}

// A loop through the copy that avoids the caps was a loop through the original.
void HandleLoops::addCopy(int original, int copy)
{
    grow();
    bound_[copy] = bound_[original];
    if (bound_[copy] >= 0) roots_.push({bound_[copy], copy});
}

std::optional<HandleLoop> HandleLoops::shortest(double longest)
{
    while (!roots_.empty()) {
        const auto [key, root] = roots_.top();
        if (key > longest || key == kInfinity) break;
        roots_.pop();
        if (key < bound_[root]) {
            roots_.push({bound_[root], root});
            continue;
        }
        const double radius = std::max(key, firstRadius_);
        std::optional<HandleLoop> loop = shortestThrough(root, radius);
        raiseBounds(loop ? loop->length : front_.empty() ? kInfinity : 2 * radius);
        for (int v : touched_) slot_[v] = -1;
        roots_.push({bound_[root], root});
        if (loop && loop->length <= longest && loop->length <= roots_.top().first) return loop;
    }
    return std::nullopt;
}

// Walk from u to the root, around its loop and back: a loop through u is shorter by 2 d(u) at most.
void HandleLoops::raiseBounds(double bound)
{
    for (size_t i = 0; i < touched_.size(); ++i) {
        double& known = bound_[touched_[i]];
        if (known >= 0 && reached_[i].settled) known = std::max(known, bound - 2 * reached_[i].distance);
    }
}

void HandleLoops::reach(int v, const Reached& how)
{
    int& slot = slot_[v];
    if (slot >= 0 && how.distance >= reached_[slot].distance) return;
    if (slot < 0) {
        slot = static_cast<int>(touched_.size());
        touched_.push_back(v);
        reached_.push_back(how);
        classOf_.resize(touched_.size() * classes_.words());
    } else {
        reached_[slot] = how;
    }
    uint64_t* own = &classOf_[static_cast<size_t>(slot) * classes_.words()];
    std::fill(own, own + classes_.words(), 0);
    if (how.entry >= 0) {
        const uint64_t* before = &classOf_[static_cast<size_t>(slot_[how.parent]) * classes_.words()];
        std::copy(before, before + classes_.words(), own);
        classes_.add(how.entry, own);
    }
    front_.push({how.distance, v});
}

// The shortest loop with a class is two shortest paths from the root and an edge between their ends.
std::optional<HandleLoop> HandleLoops::shortestThrough(int root, double radius)
{
    touched_.clear();
    reached_.clear();
    classOf_.clear();
    front_ = {};
    std::optional<int> closing;
    double length = kInfinity;
    reach(root, {0.0, -1, -1, false});
    while (!front_.empty()) {
        const auto [d, v] = front_.top();
        if (d >= length / 2 || (!closing && d > radius)) break;
        front_.pop();
        Reached& own = reached_[slot_[v]];
        if (own.settled) continue;
        own.settled = true;
        closeLoops(v, closing, length);
        surface_.forEachEdgeAt(v, [&, from = d, at = v](int h, int w) {
            reach(w, {from + surface_.length(h), h, at, false});
        });
    }
    if (!closing) return std::nullopt;
    return HandleLoop{length, loopOver(*closing)};
}

void HandleLoops::closeLoops(int v, std::optional<int>& closing, double& length)
{
    const size_t words = classes_.words();
    surface_.forEachEdgeAt(v, [&](int h, int w) {
        if (slot_[w] < 0 || !reached_[slot_[w]].settled) return;
        const double through = reached_[slot_[v]].distance + surface_.length(h) + reached_[slot_[w]].distance;
        if (through >= length) return;
        const uint64_t* a = &classOf_[static_cast<size_t>(slot_[v]) * words];
        const uint64_t* b = &classOf_[static_cast<size_t>(slot_[w]) * words];
        for (size_t i = 0; i < words; ++i) sum_[i] = a[i] ^ b[i];
        classes_.add(h, sum_.data());
        if (std::all_of(sum_.begin(), sum_.end(), [](uint64_t word) { return word == 0; })) return;
        closing = h;
        length = through;
    });
}

// Where both paths begin alike that part is no part of the loop.
std::vector<int> HandleLoops::loopOver(int closing) const
{
    const auto pathTo = [&](int v) {
        std::vector<int> path;
        for (; v >= 0; v = reached_[slot_[v]].parent) path.push_back(v);
        return path; // ends at the root
    };
    std::vector<int> loop = pathTo(surface_.tail(closing)), back = pathTo(surface_.head(closing));
    while (loop.size() > 1 && back.size() > 1 && loop[loop.size() - 2] == back[back.size() - 2])
        loop.pop_back(), back.pop_back();
    loop.insert(loop.end(), back.rbegin() + 1, back.rend());
    return loop;
}

} // namespace gimg

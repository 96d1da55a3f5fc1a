#include "gimg/image_seam.h"

#include "border_strips.h"
#include "codec/border.h"
#include "codec/seam.h"
#include "glued_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace gimg {
namespace {

constexpr double kDistinct = 4;    // tolerances: what is shorter is no run of its own
constexpr double kSlit = 20;       // tolerances: wider ones are openings
constexpr int kFarthestShift = 16; // steps that a node may slide along what coincides

// A run of the border from one corner to the next.
struct Run
{
    int begin = 0; // as found: up to a few steps off
    int end = 0;
    int sum = 0;   // position p lies on sum - p
    int mate = -1; // the run it is glued to; -1: boundary
};

// Where runs meet. Corner k is where run k begins. What is glued ties corners in pairs: x_a + x_b = sum. So
// the corners of a node are known up to one number, and exactly where they are odd in number.
class Corners
{
public:
    Corners(std::vector<Run> runs, const BorderLoop& border, double tolerance)
        : runs_(std::move(runs)), border_(border), tolerance_(tolerance)
    {
        for (const Run& run : runs_) at_.push_back(run.begin);
    }

    /// False where the ties contradict each other.
    bool solve()
    {
        std::vector<bool> seen(at_.size());
        for (const bool closed : {false, true}) // chains that end at the boundary first, from their ends
            for (int k = 0; k < count(); ++k)
                if (!seen[k] && (closed || !tieBefore(k) || !tieAfter(k)))
                    if (!solveNode(k, seen)) return false;
        for (int k = 0; k + 1 < count(); ++k)
            if (at_[k] >= at_[k + 1]) return false;
        return at_.back() < at_.front() + border_.size();
    }

    const std::vector<Run>& runs() const { return runs_; }
    int at(int k) const { return k < count() ? at_[k] : at_[k - count()] + border_.size(); }

private:
    struct Tie
    {
        int corner, sum;
    };
    struct Member
    {
        int corner, sign;
    };

    int count() const { return static_cast<int>(runs_.size()); }
    int next(int k) const { return (k + 1) % count(); }

    std::optional<Tie> tieAfter(int k) const // by the run that begins at the corner
    {
        if (runs_[k].mate < 0) return std::nullopt;
        return Tie{next(runs_[k].mate), runs_[k].sum};
    }
    std::optional<Tie> tieBefore(int k) const // by the run that ends there
    {
        const Run& run = runs_[(k + count() - 1) % count()];
        if (run.mate < 0) return std::nullopt;
        return Tie{run.mate, run.sum};
    }

    // The value nearest to `near` that is equal to `value` modulo the border's length (or half of it).
    int nearest(int value, int near, int period) const
    {
        const int off = ((value - near) % period + period) % period;
        return near + (off > period / 2 ? off - period : off);
    }

    // Walks from corner to corner around a node, or along it from the boundary to the boundary.
    bool solveNode(int first, std::vector<bool>& seen)
    {
        const int total = border_.size();
        std::vector<Member> members = {{first, 1}};
        const bool after = tieAfter(first).has_value(); // and so on: a run leads to the other end of its mate
        bool closed = false;
        seen[first] = true;
        for (int k = first;;) {
            const std::optional<Tie> tie = after ? tieAfter(k) : tieBefore(k);
            if (!tie) break;
            const int value = tie->sum - at_[k], sign = -members.back().sign;
            if (tie->corner == first) { // round
                closed = true;
                const int miss = nearest(value, at_[first], total) - at_[first];
                if (sign > 0 && miss != 0) return false;
                if (sign < 0 && miss % 2 != 0) return false;
                if (sign < 0) shift(members, miss / 2); // at_ + t = value - t
                if (sign < 0) return true;
                break;
            }
            at_[tie->corner] = nearest(value, at_[tie->corner], total);
            k = tie->corner;
            if (seen[k]) return false;
            seen[k] = true;
            members.push_back({k, sign});
        }
        if (closed) slide(members);
        return true;
    }

    void shift(const std::vector<Member>& members, int by)
    {
        for (const Member& m : members) at_[m.corner] += m.sign * by;
    }

    // A node that may lie anywhere along what coincides goes where the coarsest grid has a point.
    void slide(const std::vector<Member>& members)
    {
        const auto coarseness = [&] {
            int bits = border_.size();
            for (const Member& m : members) bits |= border_.wrapped(at_[m.corner]);
            return bits & -bits;
        };
        int best = 0, most = coarseness();
        for (const int direction : {1, -1})
            for (int by = 1; by <= kFarthestShift; ++by) {
                shift(members, direction * by);
                const bool holds = coincide(members);
                const int reached = coarseness();
                shift(members, -direction * by);
                if (!holds) break;
                if (reached > most) best = direction * by, most = reached;
            }
        shift(members, best);
    }

    bool coincide(const std::vector<Member>& members) const
    {
        return std::all_of(members.begin(), members.end(), [&](const Member& m) {
            return border_.gap(at_[m.corner], at_[members.front().corner]) <= tolerance_;
        });
    }

    std::vector<Run> runs_;
    const BorderLoop& border_;
    double tolerance_;
    std::vector<int> at_;
};

// Both runs of all strips and the boundary between them, around the border.
std::vector<Run> runsAround(const std::vector<BorderStrip>& strips, const BorderLoop& border,
                            double tolerance)
{
    std::vector<Run> glued;
    for (const BorderStrip& s : strips)
        for (const int begin : {s.begin, s.mateBegin()}) {
            const int from = border.wrapped(begin);
            glued.push_back(
                {from, from + s.length, border.wrapped(s.sum), static_cast<int>(&s - &strips[0])});
        }
    std::sort(glued.begin(), glued.end(), [](const Run& a, const Run& b) { return a.begin < b.begin; });
    std::vector<Run> runs;
    std::vector<int> first(strips.size(), -1);
    for (size_t k = 0; k < glued.size(); ++k) {
        Run run = glued[k];
        const int strip = run.mate, end = run.end;
        run.mate = first[strip];
        if (run.mate >= 0) runs[run.mate].mate = static_cast<int>(runs.size());
        first[strip] = static_cast<int>(runs.size());
        runs.push_back(run);
        const int until = k + 1 < glued.size() ? glued[k + 1].begin : glued[0].begin + border.size();
        if (border.length(end, until - end) >= kDistinct * tolerance) runs.push_back({end, until, 0, -1});
    }
    if (runs.back().begin >= border.size()) { // counting begins with the first side after the corner
        for (Run& run : runs) run.mate += run.mate < 0 ? 0 : 1;
        std::rotate(runs.begin(), runs.end() - 1, runs.end());
        runs.front().begin -= border.size();
    }
    return runs;
}

std::vector<gim_side> wordOf(const Corners& corners, int unit)
{
    std::vector<gim_side> word;
    std::vector<uint32_t> label(corners.runs().size());
    uint32_t labels = 0;
    for (int k = 0; k < static_cast<int>(corners.runs().size()); ++k) {
        const int mate = corners.runs()[k].mate;
        const uint32_t kind = mate < 0 ? GIM_SIDE_BOUNDARY : mate > k ? GIM_SIDE_FIRST : GIM_SIDE_MATE;
        label[k] = kind == GIM_SIDE_MATE ? label[mate] : labels++;
        word.push_back({label[k], static_cast<uint32_t>((corners.at(k + 1) - corners.at(k)) / unit), kind});
    }
    return word;
}

codec::Seam coded(const GridSeam& seam)
{
    return {static_cast<uint32_t>(seam.lowest), static_cast<uint32_t>(seam.start), seam.sides};
}

// Lengths in steps of another lowest grid.
GridSeam refined(const GridSeam& seam, int lowest)
{
    GridSeam fine = seam;
    const int factor = (lowest - 1) / (seam.lowest - 1);
    fine.lowest = lowest;
    fine.start *= factor;
    for (gim_side& side : fine.sides) side.length *= static_cast<uint32_t>(factor);
    return fine;
}

bool isSimplicialFrom(const GridSeam& seam, int n)
{
    for (int grid = seam.lowest; grid <= n; grid = 2 * grid - 1)
        if (!codec::seamIsSimplicial(seam.sides.data(), static_cast<uint32_t>(seam.sides.size()),
                                     static_cast<uint32_t>(seam.start), static_cast<uint32_t>(seam.lowest),
                                     static_cast<uint32_t>(grid)))
            return false;
    return true;
}

// The same seam at the coarsest lowest level at which it can be written.
std::optional<GridSeam> written(const GridSeam& seam, int n)
{
    for (GridSeam at = seam; at.lowest <= n; at = refined(at, 2 * at.lowest - 1))
        if (isSimplicialFrom(at, n)) return at;
    return std::nullopt;
}

GridSeam openSeam() { return {3, 0, {{0, 8, GIM_SIDE_BOUNDARY}}}; }

// Pieces of boundary that face each other, in between what is glued, and nearly coincide.
struct Slits
{
    int count = 0;
    double widest = 0;
};

Slits slitsOf(const Corners& corners, const BorderLoop& border, double widest)
{
    Slits slits;
    const std::vector<Run>& runs = corners.runs();
    const int count = static_cast<int>(runs.size());
    for (int k = 0; k < count; ++k) {
        const Run &before = runs[(k + count - 1) % count], &after = runs[(k + 1) % count];
        if (runs[k].mate >= 0 || before.mate < 0 || before.sum != after.sum) continue;
        if (border.wrapped(before.sum - corners.at(k + 1)) <= border.wrapped(corners.at(k)))
            continue; // its facing one
        double width = 0;
        for (int p = corners.at(k); p <= corners.at(k + 1); ++p)
            width = std::max(width, border.gap(p, before.sum - p));
        if (width > widest) continue;
        ++slits.count;
        slits.widest = std::max(slits.widest, width);
    }
    return slits;
}

class SeamFinder
{
public:
    SeamFinder(const FloatImage& image, double tolerance)
        : n_(image.width), tolerance_(tolerance), border_(image)
    {
    }

    /// The seam, or why there is none.
    GridSeam run(std::string& objection, Slits& slits) const
    {
        const std::vector<BorderStrip> strips = findStrips(border_, tolerance_, kDistinct * tolerance_);
        if (strips.empty()) return openSeam();
        Corners corners(runsAround(strips, border_, tolerance_), border_, tolerance_);
        objection = "the runs of border samples that coincide contradict each other";
        if (!corners.solve()) return openSeam();
        GridSeam seam = onCoarsest(corners);
        if (!codec::seamFault(coded(seam)).empty()) return openSeam();
        if (!holds(seam)) return openSeam();
        objection = "glued as its border samples coincide the grid is no simplicial surface";
        const std::optional<GridSeam> found = written(seam, n_);
        if (!found) return openSeam();
        objection.clear();
        slits = slitsOf(corners, border_, kSlit * tolerance_);
        return *found;
    }

private:
    GridSeam onCoarsest(const Corners& corners) const
    {
        int bits = border_.size() / 8; // 3 samples a side at least
        for (int k = 0; k < static_cast<int>(corners.runs().size()); ++k)
            bits |= border_.wrapped(corners.at(k));
        const int unit = bits & -bits;
        return {(n_ - 1) / unit + 1, border_.wrapped(corners.at(0)) / unit, wordOf(corners, unit)};
    }

    // Where nodes were moved a little, mates may be a little farther apart than what was looked for.
    bool holds(const GridSeam& seam) const
    {
        const std::vector<uint32_t> classes = codec::borderClasses(coded(seam), static_cast<uint32_t>(n_));
        for (int p = 0; p < border_.size(); ++p)
            if (border_.gap(p, static_cast<int>(classes[p])) > kDistinct * tolerance_) return false;
        return true;
    }

    int n_;
    double tolerance_;
    BorderLoop border_;
};

double diagonalOf(const FloatImage& image)
{
    Eigen::AlignedBox3d box;
    for (size_t k = 0; k < image.samples.size(); k += 3)
        box.extend(Vec3(image.samples[k], image.samples[k + 1], image.samples[k + 2]));
    return box.isEmpty() ? 0 : box.diagonal().norm();
}

// Gives glued samples their mean; returns how far the farthest two were apart.
double average(const GridSeam& seam, FloatImage& image)
{
    const auto grid = static_cast<uint32_t>(image.width);
    const std::vector<uint32_t> classes = codec::borderClasses(coded(seam), grid);
    const BorderLoop border(image);
    std::vector<Vec3> sum(classes.size(), Vec3::Zero());
    std::vector<int> count(classes.size());
    double widest = 0;
    for (size_t p = 0; p < classes.size(); ++p) {
        sum[classes[p]] += border.at(static_cast<int>(p));
        ++count[classes[p]];
    }
    for (size_t p = 0; p < classes.size(); ++p) {
        if (count[classes[p]] == 1) continue;
        const Vec3 mean = sum[classes[p]] / count[classes[p]];
        widest = std::max(widest, 2 * (mean - border.at(static_cast<int>(p))).norm());
        const size_t sample = codec::borderSample(grid, static_cast<uint32_t>(p));
        for (int c = 0; c < 3; ++c) image.samples[3 * sample + c] = static_cast<float>(mean[c]);
    }
    return widest;
}

std::optional<Error> objectionTo(const FloatImage& image, const ImageSeamOptions& options)
{
    const auto isSize = [](int n) { return n >= 3 && n <= 4097 && ((n - 1) & (n - 2)) == 0; };
    if (!(options.tolerance > 0 && options.tolerance <= 0.1))
        return Error{ErrorKind::BadArgument, "the tolerance is not above 0 and at most 0.1"};
    if (std::optional<Error> error = objectionToImage(image)) return error;
    if (!isSize(image.width))
        return Error{ErrorKind::BadArgument, "an image of " + std::to_string(image.width) +
                                                 " samples a side: it must be 2^j + 1 from 3 to 4097"};
    if (options.lowest != 0 && (!isSize(options.lowest) || options.lowest > image.width))
        return Error{ErrorKind::BadArgument, "lowest level " + std::to_string(options.lowest) +
                                                 " is not 2^l + 1, or larger than the image"};
    return std::nullopt;
}

} // namespace

Result<ImageSeam> findImageSeam(const FloatImage& image, const ImageSeamOptions& options)
{
    if (const std::optional<Error> error = objectionTo(image, options)) return *error;
    const double diagonal = diagonalOf(image);
    if (!(diagonal > 0)) return Error{ErrorKind::EmptyMesh, "all samples of the image are one point"};
    ImageSeam found;
    Slits slits;
    found.seam = SeamFinder(image, options.tolerance * diagonal).run(found.objection, slits);
    found.slits = slits.count;
    found.widestSlit = slits.widest / diagonal;
    if (options.lowest != 0 && options.lowest < found.seam.lowest)
        return Error{ErrorKind::TargetUnreachable,
                     "the image's seam needs a lowest level of " + std::to_string(found.seam.lowest)};
    if (options.lowest != 0) found.seam = refined(found.seam, options.lowest);
    found.image = image;
    found.widestGap = average(found.seam, found.image) / diagonal;
    found.steps = 4 * (image.width - 1);
    const int unit = (image.width - 1) / (found.seam.lowest - 1);
    for (const gim_side& side : found.seam.sides)
        if (side.kind != GIM_SIDE_BOUNDARY) found.glued += static_cast<int>(side.length) * unit;
    return found;
}

} // namespace gimg

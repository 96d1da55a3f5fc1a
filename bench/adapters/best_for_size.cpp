#include "best_for_size.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>

namespace gimg::adapter {
namespace {

constexpr int kRoughSamples = 20000, kFineSamples = 100000;
constexpr std::size_t kFinalists = 3;
constexpr double kFinalistsMargin = 0.3; ///< dB below the best by which one is no finalist
constexpr int kDownhill = 2; ///< numbers of bits in a row without a new best before the search turns back

using Bytes = std::vector<std::uint8_t>;

struct Candidate
{
    int bits = 0, rung = 0;
    double psnr = 0;
};

class Search
{
public:
    Search(Ladder& ladder, const MeshCodec& codec, int threads)
        : ladder_(ladder), codec_(codec), rough_(ladder.rung(0), {kRoughSamples, 1, threads}),
          fine_(ladder.rung(0), {kFineSamples, 1, threads})
    {
    }

    Result<Coded> best(std::size_t target)
    {
        target_ = target;
        // The same for a size alone as after others, so that a sweep that goes on ends with the same files.
        guess_ = 0;
        startBits_ = startBits(target);
        candidates_.clear();
        climb();
        addWhole();
        if (!failure_ && candidates_.empty())
            return Error{ErrorKind::TargetUnreachable,
                         "no mesh of " + std::to_string(kFewestTriangles) + " triangles or more fits, at " +
                             std::to_string(codec_.fewestBits) + " bits or more"};
        std::stable_sort(candidates_.begin(), candidates_.end(),
                         [](const Candidate& a, const Candidate& b) { return a.psnr > b.psnr; });
        std::erase_if(candidates_, [&, highest = candidates_.empty() ? 0 : candidates_[0].psnr](
                                       const Candidate& c) { return c.psnr < highest - kFinalistsMargin; });
        if (candidates_.size() > kFinalists) candidates_.resize(kFinalists);
        Coded best;
        double bestPsnr = -1;
        for (const Candidate& candidate : candidates_) refine(candidate, best, bestPsnr);
        if (failure_) return *failure_;
        return best;
    }

private:
    // A coder that fails, which is no matter of size, ends the search.
    template <class T> bool good(const Result<T>& result)
    {
        if (!result && !failure_) failure_ = result.error();
        return result.ok();
    }

    std::size_t sizeOf(int rung, int bits)
    {
        const auto [entry, isNew] = sizes_.try_emplace({rung, bits}, 0);
        if (isNew) {
            const Result<Bytes> file = codec_.encode(ladder_.rung(rung), bits);
            entry->second = good(file) ? file->size() : 0;
        }
        return entry->second;
    }

    // The first rung that fits, or ladder_.size(). Size goes nearly as the number of triangles, which tells
    // where to look next.
    int firstRungThatFits(int bits)
    {
        int large = -1, small = ladder_.size();
        int next = std::clamp(guess_, 0, ladder_.size() - 1);
        while (small - large > 1 && !failure_) {
            const double ratio = static_cast<double>(sizeOf(next, bits)) / static_cast<double>(target_);
            (ratio > 1 ? large : small) = next;
            const int step = static_cast<int>(std::lround(std::log(ratio) / -std::log(Ladder::kRungRatio)));
            next = std::clamp(next + step, large + 1, std::max(large + 1, small - 1));
        }
        if (small < ladder_.size()) guess_ = small;
        return small;
    }

    std::optional<double> psnr(const SurfaceMeasure& measure, const Bytes& file)
    {
        const Result<Mesh> mesh = codec_.decode(file);
        if (!good(mesh)) return std::nullopt;
        const Result<SurfaceDistance> distance = measure.against(*mesh);
        // What quantisation left without area is a bad candidate, not a failure.
        return distance ? distance->psnr() : -1;
    }

    // The candidate of a number of bits; its PSNR, or -1 where none fits.
    double tryBits(int bits)
    {
        const int rung = firstRungThatFits(bits);
        if (failure_ || rung == ladder_.size()) return -1;
        return add(rung, bits);
    }

    double add(int rung, int bits)
    {
        const Result<Bytes> file = codec_.encode(ladder_.rung(rung), bits);
        if (!good(file)) return -1;
        const std::optional<double> value = psnr(rough_, *file);
        if (!value || *value < 0) return -1;
        candidates_.push_back({bits, rung, *value});
        return *value;
    }

    // What the best files of the meshes that were tried have, by about one bit: 8 at 1.5 KB, 12 at 48 KB.
    int startBits(std::size_t target) const
    {
        const double bits = 8 + 0.8 * std::log2(static_cast<double>(target) / 1536);
        return std::clamp(static_cast<int>(std::lround(bits)), codec_.fewestBits, codec_.mostBits);
    }

    void climb()
    {
        const int start = startBits_;
        double best = tryBits(start);
        for (const int direction : {1, -1}) {
            int worse = 0;
            for (int bits = start + direction;
                 bits >= codec_.fewestBits && bits <= codec_.mostBits && worse < kDownhill && !failure_;
                 bits += direction) {
                const double value = tryBits(bits);
                worse = value > best ? 0 : worse + 1;
                best = std::max(best, value);
            }
        }
    }

    void addWhole()
    {
        int bits = codec_.mostBits;
        while (bits >= codec_.fewestBits && !failure_ && sizeOf(0, bits) > target_) --bits;
        if (failure_ || bits < codec_.fewestBits) return;
        for (const Candidate& candidate : candidates_)
            if (candidate.rung == 0 && candidate.bits == bits) return;
        add(0, bits);
    }

    // The candidate, or where there is room the largest mesh above it that fits too.
    void refine(const Candidate& candidate, Coded& best, double& bestPsnr)
    {
        if (candidate.rung > 0)
            for (const Mesh& mesh : ladder_.between(candidate.rung - 1)) {
                Result<Bytes> file = codec_.encode(mesh, candidate.bits);
                if (!good(file)) return;
                if (file->size() > target_) continue;
                return judge(std::move(*file), candidate.bits, best, bestPsnr);
            }
        Result<Bytes> file = codec_.encode(ladder_.rung(candidate.rung), candidate.bits);
        if (good(file)) judge(std::move(*file), candidate.bits, best, bestPsnr);
    }

    void judge(Bytes file, int bits, Coded& best, double& bestPsnr)
    {
        Result<Mesh> mesh = codec_.decode(file);
        if (!good(mesh)) return;
        const Result<SurfaceDistance> distance = fine_.against(*mesh);
        if (!distance || distance->psnr() <= bestPsnr) return;
        bestPsnr = distance->psnr();
        best.settings = {{"triangles", mesh->faces.size()}, {"bits", bits}};
        best.extension = codec_.extension;
        best.file = std::move(file);
        best.mesh = std::move(*mesh);
    }

    Ladder& ladder_;
    const MeshCodec& codec_;
    SurfaceMeasure rough_, fine_;
    std::map<std::pair<int, int>, std::size_t> sizes_; ///< of rung and bits
    std::vector<Candidate> candidates_;                ///< for the target
    std::optional<Error> failure_;
    std::size_t target_ = 0;
    int guess_ = 0, startBits_ = 0;
};

double milliseconds(std::chrono::steady_clock::duration time)
{
    return std::chrono::duration<double, std::milli>(time).count();
}

} // namespace

Status bestForSizes(Ladder& ladder, const MeshCodec& codec, const std::vector<std::size_t>& sizes,
                    int threads, const std::function<void(std::size_t, Result<Coded>)>& done)
{
    Search search(ladder, codec, threads);
    for (const std::size_t size : sizes) {
        Result<Coded> coded = search.best(size);
        if (!coded && coded.error().kind != ErrorKind::TargetUnreachable) return coded.error();
        done(size, std::move(coded));
    }
    return Done{};
}

Result<Times> timeRuns(int runs, const std::function<Result<Bytes>()>& encode,
                       const std::function<Status(const Bytes&)>& decode)
{
    using Clock = std::chrono::steady_clock;
    Times times;
    for (int run = 0; run < runs; ++run) {
        const Clock::time_point start = Clock::now();
        const Result<Bytes> file = encode();
        times.encode.push_back(milliseconds(Clock::now() - start));
        if (!file) return file.error();
        const Clock::time_point decoding = Clock::now();
        const Status decoded = decode(*file);
        times.decode.push_back(milliseconds(Clock::now() - decoding));
        if (!decoded) return decoded.error();
        times.bytes = file->size();
    }
    return times;
}

} // namespace gimg::adapter

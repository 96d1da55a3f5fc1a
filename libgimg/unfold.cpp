#include "gimg/unfold.h"

#include "gimg/extrema.h"
#include "gimg/stretch.h"
#include "gimg/torus_map.h"
#include "layout_search.h"
#include "one_solver_thread.h"

#include <tbb/parallel_invoke.h>

#include <mutex>
#include <optional>

namespace gimg {
namespace {

constexpr double kSure = 0.5; // of the energy: below, the extended cut is taken without trying the other

// Faces from which on the energy tells which layout errs less. With fewer, it matters as much how the grid
// happens to meet their edges.
constexpr int kSmooth = 20000;

class Unfolder
{
public:
    Unfolder(const Mesh& mesh, const UnfoldOptions& options, const UnfoldJudge& judge,
             const UnfoldProgress& progress)
        : mesh_(mesh), options_(options), judge_(judge), progress_(progress),
          coarse_(simplify(mesh, ExtremaOptions{}.faces))
    {
    }

    Result<Unfolded> run()
    {
        const Topology type = topology(mesh_);
        const bool sphere = type.genus == 0 && type.boundaries == 0;
        if (options_.layout == SquareLayout::Octahedral) {
            if (!sphere)
                return Error{ErrorKind::BadArgument,
                             "the octahedral layout is for closed surfaces of genus 0; this one has genus " +
                                 std::to_string(type.genus) + " and " + std::to_string(type.boundaries) +
                                 " boundary loops"};
            if (options_.extrema)
                return Error{ErrorKind::BadArgument, "the octahedral layout is not extended to extrema"};
            const StarTips tips = findStarTips(coarse_);
            if (tips.vertices.empty())
                return Error{ErrorKind::TargetUnreachable, "no star of four paths opens this surface"};
            return octahedral(tips);
        }
        if (options_.param == MapKind::Conformal) return conformalTorus();
        if (!sphere) return alongCut(extrema(FlattenEffort::Trial));
        if (options_.layout == SquareLayout::Cut || options_.extrema)
            return alongCut(extrema(FlattenEffort::Full));
        return starOrCut();
    }

private:
    Extrema extrema(FlattenEffort effort) const
    {
        ExtremaOptions options;
        options.effort = effort;
        options.most = options_.extrema.value_or(options.most);
        return findExtrema(coarse_, options, [&](double fraction) { progress_("cut", fraction); });
    }

    Result<Unfolded> starOrCut()
    {
        constexpr double kEven = 3;      // times the least energy possible: no need to look further
        constexpr double kFarMore = 0.7; // of the star's: below, the cut is taken without trying the star
        const double area = surfaceArea(coarse_.mesh);
        const StarTips tips = findStarTips(coarse_);
        if (!tips.vertices.empty() && tips.energy < kEven * area * area * area) {
            if (Result<Unfolded> star = octahedral(tips)) return star;
            return alongCut(extrema(FlattenEffort::Full));
        }
        const Extrema reached = extrema(FlattenEffort::Full);
        if (tips.vertices.empty() || reached.energyWith <= kFarMore * tips.energy) return alongCut(reached);
        // Energies do not decide: the star's seam is the shorter one, the cut's layout can still be improved.
        const OneSolverThread oneThread; // each
        struct Tried
        {
            std::optional<Result<Unfolded>> unfolded;
            double quality = 0;
        } star, cut;
        const auto judge = [this](Tried& tried, Result<Unfolded> unfolded) {
            if (unfolded) tried.quality = quality(*unfolded);
            tried.unfolded = std::move(unfolded);
        };
        tbb::parallel_invoke([&] { judge(star, octahedral(tips)); }, [&] { judge(cut, alongCut(reached)); });
        if (!*star.unfolded || !*cut.unfolded) return std::move(*(*star.unfolded ? star : cut).unfolded);
        return std::move(*(star.quality > cut.quality ? star : cut).unfolded);
    }

    Result<Unfolded> conformalTorus()
    {
        if (options_.extrema)
            return Error{ErrorKind::BadArgument, "a conformal map is not extended to extrema"};
        Result<TorusMap> torus = torusToSquare(mesh_, options_);
        if (!torus) return torus.error();
        return Unfolded{torus->square.cut, SquareLayout::Cut, 0, std::move(torus->square),
                        std::move(torus->map)};
    }

    Result<Unfolded> octahedral(const StarTips& tips)
    {
        return flattened(starCut(mesh_, tips.vertices), static_cast<int>(tips.vertices.size()),
                         SquareLayout::Octahedral);
    }

    Result<Unfolded> alongCut(const Extrema& reached)
    {
        const int count = static_cast<int>(reached.vertices.size());
        if (count == 0) return settled(cutToDisk(mesh_), 0);
        const CutGraph cut = cutToDisk(mesh_, reached.vertices);
        if (options_.extrema) return settled(cut, count);
        if (reached.energyWith < kSure * reached.energyWithout)
            if (Result<Unfolded> extended = settled(cut, count)) return extended;
        Result<Unfolded> extended = flattened(cut, count, SquareLayout::Cut);
        Result<Unfolded> plain = flattened(cutToDisk(mesh_), 0, SquareLayout::Cut);
        if (!extended && !plain) return plain;
        return settled(!plain || (extended && quality(*extended) >= quality(*plain)) ? *extended : *plain);
    }

    Result<Unfolded> flattened(CutGraph cut, int extrema, SquareLayout layout)
    {
        BorderOptions options = options_;
        options.layout = layout;
        Result<SquareDisk> square = layOutBorder(mesh_, cut, options);
        if (!square) return square.error();
        return flattened(std::move(cut), std::move(*square), extrema, layout);
    }

    // Along a cut that is decided, in the layout of a search where that is better.
    Result<Unfolded> settled(const CutGraph& cut, int extrema) const
    {
        constexpr double kClear = 0.92; // of the energy
        BorderOptions options = options_;
        options.layout = SquareLayout::Cut;
        Result<SquareDisk> square = layOutBorder(mesh_, cut, options);
        if (!square) return square.error();
        const ImprovedLayout found = improvement(cut, layoutOf(*square));
        if (mesh_.faceCount() >= kSmooth) {
            if (found.energy < kClear)
                if (Result<Unfolded> sure = laidOut(cut, found.layout, square->grid, extrema)) return sure;
            return flattened(cut, std::move(*square), extrema, SquareLayout::Cut);
        }
        return better(flattened(cut, std::move(*square), extrema, SquareLayout::Cut), found.layout);
    }

    Result<Unfolded> settled(const Unfolded& before) const
    {
        return better(before, improvement(before.cut, layoutOf(before.square)).layout);
    }

    // The linear maps hold the whole border where the first layout puts it.
    ImprovedLayout improvement(const CutGraph& cut, const BorderLayout& first) const
    {
        return options_.param == MapKind::Stretch ? improveLayout(mesh_, cut, first) : ImprovedLayout{first};
    }

    Result<Unfolded> better(Result<Unfolded> before, const BorderLayout& layout) const
    {
        if (!before || layout == layoutOf(before->square)) return before;
        Result<Unfolded> after = laidOut(before->cut, layout, before->square.grid, before->extrema);
        return after && isBetter(*after, *before) ? std::move(after) : std::move(before);
    }

    static BorderLayout layoutOf(const SquareDisk& square)
    {
        return {square.lowest, square.start, square.pathLength};
    }

    Result<Unfolded> laidOut(const CutGraph& cut, const BorderLayout& layout, int grid, int extrema) const
    {
        Result<SquareDisk> square = layOutBorder(mesh_, cut, layout, grid);
        if (!square) return square.error();
        return flattened(cut, std::move(*square), extrema, SquareLayout::Cut);
    }

    bool isBetter(const Unfolded& after, const Unfolded& before) const
    {
        constexpr double kBareLoss = 0.2; // dB
        if (!judge_.coded) return quality(after) > quality(before);
        return judge_.bare(after) > judge_.bare(before) - kBareLoss &&
               judge_.coded(after) > judge_.coded(before);
    }

    Result<Unfolded> flattened(CutGraph cut, SquareDisk square, int extrema, SquareLayout layout) const
    {
        Result<Parameterization> map = mapToSquare(
            square, options_.param, [&](double fraction) { progress_("parameterize", fraction); },
            options_.density);
        if (!map) return map.error();
        return Unfolded{std::move(cut), layout, extrema, std::move(square), std::move(*map)};
    }

    double quality(const Unfolded& unfolded) const
    {
        return judge_.coded ? judge_.coded(unfolded)
                            : -quarticStretchEnergy(unfolded.square.disk.mesh, unfolded.map.st);
    }

    const Mesh& mesh_;
    const UnfoldOptions& options_;
    const UnfoldJudge& judge_;
    const UnfoldProgress& progress_;
    const SimplifiedMesh coarse_;
};

} // namespace

Result<Unfolded> unfold(const Mesh& mesh, const UnfoldOptions& options, const UnfoldJudge& judge,
                        const UnfoldProgress& progress)
{
    std::mutex oneReport; // while two layouts are flattened at a time
    const UnfoldProgress inTurn = [&](const char* stage, double fraction) {
        const std::lock_guard lock(oneReport);
        if (progress) progress(stage, fraction);
    };
    return Unfolder(mesh, options, judge, inTurn).run();
}

} // namespace gimg

#include "gimg/unfold.h"

#include "gimg/extrema.h"
#include "gimg/stretch.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace gimg {
namespace {

constexpr double kSure = 0.5; // of the energy: below, the extended cut is taken without trying the other

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
            const StarTips tips = findStarTips(coarse_);
            if (tips.vertices.empty())
                return Error{ErrorKind::TargetUnreachable, "no star of four paths opens this surface"};
            return octahedral(tips);
        }
        if (options_.layout == SquareLayout::Cut || !sphere) return alongCut(extrema());
        return better();
    }

private:
    Extrema extrema() const
    {
        return findExtrema(coarse_, {}, [&](double fraction) {
            if (progress_) progress_("cut", fraction);
        });
    }

    Result<Unfolded> better()
    {
        constexpr double kEven = 3;      // times the least energy possible: no need to look further
        constexpr double kFarMore = 0.7; // of the star's energy
        const double area = surfaceArea(coarse_.mesh);
        const StarTips tips = findStarTips(coarse_);
        if (!tips.vertices.empty() && tips.energy < kEven * area * area * area) {
            if (Result<Unfolded> star = octahedral(tips)) return star;
            return alongCut(extrema());
        }
        const Extrema reached = extrema();
        if (!tips.vertices.empty() && tips.energy * kFarMore < reached.energyWith)
            if (Result<Unfolded> star = octahedral(tips)) return star;
        return alongCut(reached);
    }

    Result<Unfolded> octahedral(const StarTips& tips)
    {
        return flattened(starCut(mesh_, tips.vertices), static_cast<int>(tips.vertices.size()),
                         SquareLayout::Octahedral);
    }

    Result<Unfolded> alongCut(const Extrema& reached)
    {
        const auto along = [&](std::span<const int> vertices) {
            return flattened(cutToDisk(mesh_, vertices), static_cast<int>(vertices.size()),
                             SquareLayout::Cut);
        };
        if (reached.vertices.empty()) return along({});
        Result<Unfolded> extended = along(reached.vertices);
        if (extended && reached.energyWith < kSure * reached.energyWithout) return extended;
        Result<Unfolded> plain = along({});
        if (!extended) return plain;
        if (!plain) return extended;
        return quality(*extended) >= quality(*plain) ? std::move(extended) : std::move(plain);
    }

    Result<Unfolded> flattened(CutGraph cut, int extrema, SquareLayout layout)
    {
        BorderOptions options = options_;
        options.layout = layout;
        Result<SquareDisk> square = layOutBorder(mesh_, cut, options);
        if (!square) return square.error();
        Result<Parameterization> map = mapToSquare(
            *square, options_.param,
            [&](double fraction) {
                if (progress_) progress_("parameterize", fraction);
            },
            options_.density);
        if (!map) return map.error();
        return Unfolded{std::move(cut), layout, extrema, std::move(*square), std::move(*map)};
    }

    double quality(const Unfolded& unfolded) const
    {
        return judge_ ? judge_(unfolded) : -quarticStretchEnergy(unfolded.square.disk.mesh, unfolded.map.st);
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
    return Unfolder(mesh, options, judge, progress).run();
}

} // namespace gimg

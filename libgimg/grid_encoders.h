#pragma once

#include "coded_file.h"
#include "fit_rounds.h"
#include "slide.h"

#include "gimg/encode.h"

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

namespace gimg {

/// A surface on the square, to be sampled at any grid.
struct GridSource
{
    std::shared_ptr<const Mesh> surface; ///< what samples slide along, and are fitted to
    GridSeam seam;
    std::function<Result<FloatImage>(int grid)> sample;
    FloatImage normals;                                 ///< empty: none
    std::shared_ptr<const AttributeSampler> attributes; ///< null: none
    int fitRounds = 0;                                  ///< 0: samples stay as they are
    bool features = false;
    bool refits = false;  ///< whether Slide::refit is allowed
    int smoothLevels = 0; ///< see codec::Source
};

/// Encoders of one surface at several grids, each made when first asked for. Thread-safe.
class GridEncoders
{
public:
    explicit GridEncoders(GridSource source) : source_(std::move(source)) {}

    struct Sampled
    {
        codec::Encoder encoder;
        FloatImage geometry, normals;
        double seamLength;
        std::optional<FitGain> fit;
        std::optional<FeatureReport> features;
        double sampleSeconds, fitSeconds;
    };

    /// @param lossy  what the samples are for: it makes a difference to those along sharp edges
    Result<std::shared_ptr<const Sampled>> at(int grid, bool lossy, const SurfaceMeasure& measure);

    /// Samples on their way along the surface. Copies go their own ways, but only one of them may refit at a
    /// time.
    class Slide
    {
    public:
        /// Codes at this step, or coarser ones, and moves the targets, as often as told.
        Status move(float step, const codec::Slides& slides);

        /// Fits the surface of a decoded image anew, and takes its samples: where samples have slid to they
        /// want another height above the mesh.
        Status refit(const FloatImage& decoded);
        bool mayRefit() const;

        /// The encoder of the samples where they are; normals and attributes are those of where they were.
        codec::Encoder finished() const { return encoder_.withFieldsOf(sampled_->encoder); }

    private:
        friend class GridEncoders;
        Slide(const GridEncoders& encoders, const Sampled& sampled, SampleSlide slide)
            : encoders_(&encoders), sampled_(&sampled), encoder_(sampled.encoder), slide_(std::move(slide))
        {
        }
        const GridEncoders* encoders_;
        const Sampled* sampled_;
        codec::Encoder encoder_;
        SampleSlide slide_;
        std::shared_ptr<FitRounds> rounds_; // made when needed
    };

    /// @param sampled  of this object
    Result<Slide> slide(const Sampled& sampled);

    bool hasFields() const { return source_.normals.width > 0 || source_.attributes; }

    /// The file with the normals and attributes of where the decoder puts its samples.
    /// @param sampled  of this object
    Result<std::vector<uint8_t>> withFields(std::vector<uint8_t> file, const Sampled& sampled,
                                            const EncodeGoal& goal) const;

private:
    Result<std::vector<SampledAttribute>> attributesAt(const FloatImage& geometry) const;
    Status fit(bool lossy, const SurfaceMeasure& measure, FloatImage& geometry, FloatImage& normals,
               std::optional<FitGain>& gain, std::optional<FeatureReport>& features) const;

    const GridSource source_;
    std::shared_ptr<const SlideSurface> slideSurface_;
    std::mutex mutex_;
    std::map<std::pair<int, bool>, std::shared_ptr<const Sampled>> made_;
};

} // namespace gimg

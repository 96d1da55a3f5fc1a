#pragma once

#include "surface_frame.h"

namespace gimg::codec {

/// The directions in which three channels of a field are coded.
enum class FieldAxes : std::uint8_t
{
    Channels = 0, ///< each by itself
    Mean = 1,     ///< their mean and two differences: of colours
    Radial = 2,   ///< along the prediction and across it: of unit vectors
};

/// What the chunk of a field tells before its coded samples.
struct FieldParameters
{
    double step = 1;
    FieldAxes axes = FieldAxes::Channels; ///< of groups of three; others are coded by channel
    double ratio = 1;                     ///< of the steps of what matters less: differences, the length
};

/// How buildSurface() is to take the details of up to three channels of a field.
class FieldFrames
{
public:
    FieldFrames(const FieldParameters& parameters, unsigned channels)
        : parameters_(parameters), channels_(channels)
    {
        if (channels < kComponents) parameters_.axes = FieldAxes::Channels;
    }

    unsigned components() const { return channels_; }
    double coarseStep() const { return parameters_.step; }
    void begin(SurfaceLevel&, const double* const (&)[kComponents]) const {}

    Frame at(const double* const (&planes)[kComponents], const SurfaceLevel& level, std::uint32_t i,
             std::uint32_t j) const
    {
        Frame frame;
        for (double& step : frame.step) step = parameters_.step;
        frame.axis[0] = {1, 0, 0};
        frame.axis[1] = {0, 1, 0};
        frame.axis[2] = {0, 0, 1};
        if (parameters_.axes == FieldAxes::Mean) {
            frame.axis[0] = {0.5773502691896258, 0.5773502691896258, 0.5773502691896258};
            frame.axis[1] = {0.7071067811865476, 0, -0.7071067811865476};
            frame.axis[2] = {0.4082482904638631, -0.8164965809277261, 0.4082482904638631};
            frame.step[1] = frame.step[2] = parameters_.step * parameters_.ratio;
        } else if (parameters_.axes == FieldAxes::Radial) {
            frame.step[0] = parameters_.step * parameters_.ratio;
            turn(frame, sampleOf(planes, j * std::size_t{level.size} + i), planes, level, i, j);
        }
        return frame;
    }

private:
    // The first axis along the vector that is predicted, the second along what of its change is across that.
    static void turn(Frame& frame, Vector here, const double* const (&planes)[kComponents],
                     const SurfaceLevel& level, std::uint32_t i, std::uint32_t j)
    {
        const double squared = dot(here, here);
        if (!(squared > 0)) return;
        const Vector radial = (1.0 / std::sqrt(squared)) * here;
        const Derivatives d = derivativesAt(planes, level, i, j);
        const Vector across = d.i - dot(d.i, radial) * radial;
        const double length = dot(across, across);
        if (!(length > 0)) return;
        frame.axis[0] = radial;
        frame.axis[1] = (1.0 / std::sqrt(length)) * across;
        frame.axis[2] = cross(frame.axis[0], frame.axis[1]);
    }

    FieldParameters parameters_;
    unsigned channels_;
};

} // namespace gimg::codec

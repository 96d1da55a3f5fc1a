#pragma once

#include "bit_model.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace gimg::codec {

/// Mirrors a coder, but only adds up how many bits a value would take.
class BitCounter
{
public:
    static constexpr bool kAdapts = false;

    bool bit(BitModel& model, bool one) { return code(model.zero(), one); }

    bool code(std::uint32_t zero, bool one)
    {
        bits_ += costTable()[(one ? (1u << kProbabilityBits) - zero : zero) >> kTableShift];
        return one;
    }

    std::uint32_t raw(unsigned count, std::uint32_t value) { return bits_ += count, value; }
    void fail() {}
    double bits() const { return bits_; }

private:
    static constexpr unsigned kTableShift = 4;

    static const std::array<double, (1u << (kProbabilityBits - kTableShift)) + 1>& costTable()
    {
        static const auto table = [] {
            std::array<double, (1u << (kProbabilityBits - kTableShift)) + 1> costs{};
            const double unit = static_cast<double>(1u << (kProbabilityBits - kTableShift));
            for (std::size_t k = 0; k < costs.size(); ++k)
                costs[k] = -std::log2((static_cast<double>(k) + 0.5) / unit);
            return costs;
        }();
        return table;
    }

    double bits_ = 0;
};

/// The magnitude to code for a number of `size` steps: of the nearest, the one below and 0 where that is
/// near, the one with the least error^2 + worth bits, the error in steps.
/// @param bitsOf  what coding a magnitude would take
template <class BitsOf> std::int32_t thriftyMagnitude(double size, double worth, const BitsOf& bitsOf)
{
    const auto nearest = static_cast<std::int32_t>(size + 0.5);
    if (nearest == 0) return 0;
    const auto cost = [&](std::int32_t magnitude) {
        const double error = size - magnitude;
        return error * error + worth * bitsOf(magnitude);
    };
    std::int32_t best = nearest;
    double bestCost = cost(nearest);
    const std::int32_t others[2] = {nearest - 1, 0};
    for (int k = nearest == 1 ? 1 : 0; k < (nearest <= 2 ? 2 : 1); ++k) {
        const double candidate = cost(others[k]);
        if (candidate < bestCost) bestCost = candidate, best = others[k];
    }
    return best;
}

} // namespace gimg::codec

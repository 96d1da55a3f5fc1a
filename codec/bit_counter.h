#pragma once

#include "bit_model.h"

#include <array>
#include <cmath>

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

} // namespace gimg::codec

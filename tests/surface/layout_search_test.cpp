#include "border_layout.h"
#include "border_ties.h"
#include "gimg/flatten.h"
#include "gimg/stretch.h"
#include "layout_model.h"
#include "layout_search.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

BorderLayout proportional(const Mesh& mesh, const CutGraph& cut, int lowest = 33)
{
    BorderOptions options;
    options.lowest = lowest;
    const Result<SquareDisk> square = layOutBorder(mesh, cut, options);
    EXPECT_TRUE(square.ok()) << square.error().message;
    return {square->lowest, square->start, square->pathLength};
}

struct Flattened
{
    SquareDisk square;
    Parameterization map;
    double energy;
};

Flattened flatten(const Mesh& mesh, const CutGraph& cut, const BorderLayout& layout)
{
    Result<SquareDisk> square = layOutBorder(mesh, cut, layout, 257);
    EXPECT_TRUE(square.ok()) << square.error().message;
    Result<Parameterization> map = flattenToSquare(*square, {}, {}, FlattenEffort::Converged);
    EXPECT_TRUE(map.ok()) << map.error().message;
    const double energy = quarticStretchEnergy(square->disk.mesh, map->st);
    return {std::move(*square), std::move(*map), energy};
}

TEST(LayoutModel, SlopeAgreesWithFlatteningAnew)
{
    // In so fine a unit the changes are small, and the slope tells nearly all.
    const Mesh mesh = shapes::surfaceOfGenus(2, 0, 4);
    const CutGraph cut = cutToDisk(mesh);
    const BorderLayout layout = proportional(mesh, cut, 257);
    const Flattened at = flatten(mesh, cut, layout);
    const LayoutModel model(at.square, std::vector<double>(at.square.surface.positions.size(), 1.0),
                            at.map.st);
    EXPECT_NEAR(model.energy(), at.energy, 1e-9 * at.energy);
    int tried = 0;
    double most = 0;
    for (size_t p = 0; p + 1 < layout.pathLength.size() && tried < 4; ++p) {
        BorderLayout other = layout;
        other.pathLength[p] += 4;
        other.pathLength[p + 1] -= 4;
        const std::optional<double> expected = model.energy(other);
        if (other.pathLength[p + 1] < 3 || !expected) continue;
        const double change = flatten(mesh, cut, other).energy / at.energy - 1;
        EXPECT_NEAR(*expected / at.energy - 1, change, 0.0025) << p;
        most = std::max(most, std::abs(change));
        ++tried;
    }
    EXPECT_GE(tried, 3);
    EXPECT_GT(most, 0.008);
}

TEST(LayoutModel, KeepsSilentWhereACornerFallsIntoAnotherPath)
{
    const Mesh mesh = shapes::torus(2, 1, 24, 12);
    const CutGraph cut = cutToDisk(mesh);
    const BorderLayout layout = proportional(mesh, cut);
    const Flattened at = flatten(mesh, cut, layout);
    const LayoutModel model(at.square, std::vector<double>(at.square.surface.positions.size(), 1.0),
                            at.map.st);
    BorderLayout other = layout;
    EXPECT_TRUE(model.energy(other).has_value());
    other.start += layout.pathLength[0] / 2 + 1;
    EXPECT_FALSE(model.energy(other).has_value());
}

// Largest k so that 2^k divides the start, all lengths and the side.
int alignment(const BorderLayout& layout)
{
    int k = 0;
    const auto divides = [&](int unit) {
        return layout.start % unit == 0 && (layout.lowest - 1) % unit == 0 &&
               std::all_of(layout.pathLength.begin(), layout.pathLength.end(),
                           [&](int length) { return length % unit == 0; });
    };
    while (k < 16 && divides(2 << k)) ++k;
    return k;
}

TEST(LayoutSearch, ATorusIsLaidOutWithoutConePoints)
{
    const Mesh mesh = shapes::torus(2, 1, 32, 16);
    const CutGraph cut = cutToDisk(mesh);
    const BorderLayout first = proportional(mesh, cut);
    const ImprovedLayout found = improveLayout(mesh, cut, first);
    EXPECT_LT(found.energy, 0.85);
    const Flattened before = flatten(mesh, cut, first), after = flatten(mesh, cut, found.layout);
    EXPECT_LT(after.energy, 0.85 * before.energy);
    EXPECT_GE(alignment(found.layout), 2);

    const BorderTies ties = borderTies(after.square);
    EXPECT_GE(ties.anchor, 0); // nothing has to be held: one vertex is, for a place to begin
    EXPECT_LT(borderTies(before.square).anchor, 0);
    // The four corners of the square are nodes of the cut.
    int corners = 0;
    int position = found.layout.start;
    for (const DiskSide& side : after.square.disk.sides) {
        corners += position % (found.layout.lowest - 1) == 0;
        position += found.layout.pathLength[side.path];
    }
    EXPECT_EQ(corners, 4);
}

TEST(LayoutSearch, WhatItFindsIsSound)
{
    const Mesh mesh = shapes::surfaceOfGenus(1, 2, 6);
    const CutGraph cut = cutToDisk(mesh);
    const Result<DiskMesh> disk = openAlong(mesh, cut);
    const ImprovedLayout found = improveLayout(mesh, cut, proportional(mesh, cut));
    EXPECT_TRUE(isSound(found.layout, *disk, cut));
    int perimeter = 0;
    const std::vector<PathNeeds> needs = pathNeeds(cut);
    for (size_t p = 0; p < needs.size(); ++p) {
        EXPECT_GE(found.layout.pathLength[p], needs[p].minimum);
        perimeter += needs[p].multiplicity * found.layout.pathLength[p];
    }
    EXPECT_EQ(perimeter, 4 * (found.layout.lowest - 1));
}

TEST(Border, LayoutsThatDoNotFillTheBorderAreRefused)
{
    const Mesh mesh = shapes::torus(2, 1, 12, 6);
    const CutGraph cut = cutToDisk(mesh);
    const BorderLayout good = proportional(mesh, cut);
    BorderLayout layout = good;
    ++layout.pathLength[0];
    EXPECT_EQ(layOutBorder(mesh, cut, layout, 65).error().kind, ErrorKind::BadArgument);
    layout = good;
    layout.start = 128;
    EXPECT_EQ(layOutBorder(mesh, cut, layout, 65).error().kind, ErrorKind::BadArgument);
    layout = good;
    layout.pathLength.pop_back();
    EXPECT_EQ(layOutBorder(mesh, cut, layout, 65).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(layOutBorder(mesh, cut, good, 17).error().kind, ErrorKind::BadArgument);
    EXPECT_TRUE(layOutBorder(mesh, cut, good, 65).ok());
}

} // namespace
} // namespace gimg

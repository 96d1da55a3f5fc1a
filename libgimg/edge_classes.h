#pragma once

#include "editable_surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gimg {

/// An element of the first homology group with coefficients in Z/2, as a row of bits.
using HomologyClass = std::vector<uint64_t>;

/// Every edge's values under a basis of the first cohomology group with coefficients in Z/2, boundary loops
/// filled. The sum over a closed chain of edges is zero where the chain separates the surface, and only
/// there. Source: tree-cotree decomposition, Eppstein 2003; annotated edges, Busaryev et al. 2012.
class EdgeClasses
{
public:
    /// @param surface  connected
    explicit EdgeClasses(const EditableSurface& surface);

    int genus() const { return genus_; } ///< of the surface as it was given
    size_t words() const { return words_; }

    /// Adds the class of the edge of halfedge h to `sum`, which has words() elements.
    void add(int h, uint64_t* sum) const
    {
        const uint64_t* row = &table_[static_cast<size_t>(row_[h]) * words_];
        if (row_[h] != 0)
            for (size_t i = 0; i < words_; ++i) sum[i] ^= row[i];
    }
    bool isZero(int h) const;

    /// From now on `loop`, not zero, counts as zero: it was cut open and both sides were filled.
    void divideBy(const HomologyClass& loop);

    /// Gives the halfedges of a face that was added their classes.
    void append(const HomologyClass& a, const HomologyClass& b, const HomologyClass& c);

private:
    int rowOf(const HomologyClass& value);

    int genus_ = 0;
    size_t words_ = 0;
    std::vector<int> row_;        // per halfedge: into the table
    std::vector<uint64_t> table_; // row 0 is zero
};

} // namespace gimg

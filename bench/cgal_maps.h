#pragma once

#include "gimg/border.h"

#include <string>
#include <vector>

/// CGAL's parameterizers (package Surface_mesh_parameterization), as gimg_parameterizers compares with them.
namespace gimg::bench {

struct CgalMap
{
    std::string map, border; ///< border is empty where the map has a free one
};

/// "barycentric", "harmonic", "authalic" and "mean value" with each of the borders "gimg's" (the positions
/// that the layout gave), "arc length" and "uniform" (CGAL's own squares); then "ARAP".
std::vector<CgalMap> cgalMaps();

/// A disk as CGAL holds it.
class CgalDisk
{
public:
    explicit CgalDisk(const SquareDisk& square);
    ~CgalDisk();
    CgalDisk(const CgalDisk&) = delete;
    CgalDisk& operator=(const CgalDisk&) = delete;

    /// One position per disk vertex; none where CGAL reports an error, which goes to `error`.
    std::vector<Vec2> run(const CgalMap& map, std::string& error) const;

private:
    struct Held;
    Held* held_;
};

} // namespace gimg::bench

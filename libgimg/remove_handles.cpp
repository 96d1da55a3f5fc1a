#include "gimg/topology_noise.h"

#include "edge_classes.h"
#include "editable_surface.h"
#include "handle_loops.h"

#include <array>
#include <cassert>
#include <string>

namespace gimg {
namespace {

class HandleCutter
{
public:
    explicit HandleCutter(const Mesh& mesh)
        : surface_(mesh), classes_(surface_), loops_(surface_, classes_), genus_(classes_.genus()),
          diagonal_(boundingBoxDiagonal(mesh))
    {
    }

    HandleRemoval run(const HandleOptions& options)
    {
        HandleRemoval result;
        while (genus_ > options.maxGenus) {
            const std::optional<HandleLoop> loop = loops_.shortest(options.maxLength);
            if (!loop) break;
            result.handles.push_back(described(*loop));
            remove(loop->vertices);
            --genus_;
        }
        result.mesh = surface_.mesh();
        assert(topology(result.mesh).genus == genus_);
        return result;
    }

private:
    Vec3 centre(const std::vector<int>& loop) const
    {
        Vec3 sum = Vec3::Zero();
        for (int v : loop) sum += surface_.position(v);
        return sum / static_cast<double>(loop.size());
    }

    RemovedHandle described(const HandleLoop& loop) const
    {
        return {loop.length, loop.length / diagonal_, static_cast<int>(loop.vertices.size()),
                centre(loop.vertices)};
    }

    HomologyClass classOf(const EditableSurface::Cut& cut, size_t i) const
    {
        HomologyClass value(classes_.words(), 0);
        const int left = cut.left.sides[i];
        classes_.add(left >= 0 ? left : cut.right.sides[i], value.data());
        return value;
    }

    void remove(const std::vector<int>& loop)
    {
        const EditableSurface::Cut cut = surface_.cutAlong(loop);
        HomologyClass all(classes_.words(), 0);
        const auto addEdge = [&](HomologyClass& value, size_t i) {
            const HomologyClass edge = classOf(cut, i);
            for (size_t k = 0; k < value.size(); ++k) value[k] ^= edge[k];
        };
        for (size_t i = 0; i < loop.size(); ++i) addEdge(all, i);
        classes_.divideBy(all);
        // The class of the way from the loop's first vertex, around it, to each: what a spoke makes up for.
        std::vector<HomologyClass> way(loop.size() + 1, HomologyClass(classes_.words(), 0));
        for (size_t i = 0; i < loop.size(); ++i) {
            way[i + 1] = way[i];
            addEdge(way[i + 1], i);
        }
        for (size_t i = 0; i < loop.size(); ++i) loops_.addCopy(loop[i], cut.right.vertices[i]);
        cap(cut, cut.left, way, true);
        cap(cut, cut.right, way, false);
    }

    // @param left  the side whose halfedges run along the loop; caps run against them
    void cap(const EditableSurface::Cut& cut, const EditableSurface::Loop& side,
             const std::vector<HomologyClass>& way, bool left)
    {
        const size_t n = side.vertices.size();
        if (n == 3) return capByOne(cut, side, left);
        const int middle = surface_.addVertex(centre(side.vertices));
        std::vector<int> faces;
        for (size_t i = 0; i < n; ++i) {
            const int v = side.vertices[i], w = side.vertices[(i + 1) % n];
            faces.push_back(surface_.addFace({left ? w : v, left ? v : w, middle}));
            const HomologyClass &first = left ? way[i + 1] : way[i], &second = left ? way[i] : way[i + 1];
            classes_.append(classOf(cut, i), second, first); // from the rim's second corner in, and out
            surface_.glue(faces[i], side.sides[i]);
        }
        for (size_t i = 0; i < n; ++i) {
            const int here = faces[i], after = faces[(i + 1) % n];
            if (left)
                surface_.glue(here + 2, after + 1);
            else
                surface_.glue(here + 1, after + 2);
        }
        loops_.addRoot(middle);
    }

    void capByOne(const EditableSurface::Cut& cut, const EditableSurface::Loop& side, bool left)
    {
        const auto& [a, b, c] = std::array{side.vertices[0], side.vertices[1], side.vertices[2]};
        const std::array<size_t, 3> edges =
            left ? std::array<size_t, 3>{1, 0, 2} : std::array<size_t, 3>{0, 1, 2};
        const int face = surface_.addFace(left ? Triangle{c, b, a} : Triangle{a, b, c});
        classes_.append(classOf(cut, edges[0]), classOf(cut, edges[1]), classOf(cut, edges[2]));
        for (int k = 0; k < 3; ++k) surface_.glue(face + k, side.sides[edges[k]]);
    }

    EditableSurface surface_;
    EdgeClasses classes_;
    HandleLoops loops_;
    int genus_;
    double diagonal_;
};

} // namespace

Result<HandleRemoval> removeHandles(const Mesh& mesh, const HandleOptions& options)
{
    if (options.maxGenus < 0)
        return Error{ErrorKind::BadArgument,
                     "the largest genus is negative: " + std::to_string(options.maxGenus)};
    if (!(options.maxLength >= 0))
        return Error{ErrorKind::BadArgument, "the longest loop has no length >= 0"};
    return HandleCutter(mesh).run(options);
}

} // namespace gimg

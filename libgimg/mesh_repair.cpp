#include "mesh_repair.h"

#include "polygon_triangulator.h"
#include "vertex_attributes.h"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <unordered_map>

namespace gimg {

namespace {

/// Disjoint sets of 0..n-1, each named by its least member.
class DisjointSets
{
public:
    explicit DisjointSets(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }

    int find(int i)
    {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void unite(int a, int b)
    {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<int> parent_;
};

/// The halfedges 3 f + k (corner k to the next one of face f) on one edge stand side by side.
struct EdgeUse
{
    uint64_t edge;
    int h;
};

std::vector<EdgeUse> sortedEdgeUses(const std::vector<Triangle>& faces)
{
    std::vector<EdgeUse> uses(3 * faces.size());
    for (size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(faces[f][k], faces[f][(k + 1) % 3]);
            uses[3 * f + k] = {static_cast<uint64_t>(low) << 32 | static_cast<uint32_t>(high),
                               static_cast<int>(3 * f + k)};
        }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.h < b.h;
    });
    return uses;
}

template <class Visit> void forEachEdge(const std::vector<EdgeUse>& uses, Visit visit)
{
    for (size_t i = 0, j; i < uses.size(); i = j) {
        for (j = i + 1; j < uses.size() && uses[j].edge == uses[i].edge;) ++j;
        visit(&uses[i], &uses[i] + (j - i));
    }
}

/// What keeps triangles from being an oriented manifold. The first element of each kind is the one in the
/// lowest place of the file.
struct Defects
{
    int64_t nonManifoldEdges = 0;
    int edgeA = 0, edgeB = 0, edgeFaces = 0; ///< the first of them

    int64_t nonManifoldVertices = 0;
    int vertex = 0, vertexFans = 0; ///< the first of them

    bool orientable = true;
    int conflictA = 0, conflictB = 0; ///< an edge whose two faces cannot agree

    std::vector<bool> flip; ///< faces to reverse for a consistent orientation
    bool closed = true;
};

int cornerAt(const std::vector<Triangle>& faces, int f, int v)
{
    for (int k = 0; k < 3; ++k)
        if (faces[f][k] == v) return 3 * f + k;
    return -1; // not reached: v is a vertex of f
}

void findNonManifoldVertices(const std::vector<Triangle>& faces, int vertexCount,
                             const std::vector<EdgeUse>& uses, Defects& defects)
{
    // Corners of one vertex that are joined across edges form a fan.
    DisjointSets fans(3 * faces.size());
    forEachEdge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
        const int ends[] = {static_cast<int>(first->edge >> 32), static_cast<int>(first->edge & 0xffffffffU)};
        for (const EdgeUse* use = first + 1; use < last; ++use)
            for (int v : ends) fans.unite(cornerAt(faces, first->h / 3, v), cornerAt(faces, use->h / 3, v));
    });
    std::vector<int> fanCount(static_cast<size_t>(vertexCount), 0);
    for (int c = 0; c < static_cast<int>(3 * faces.size()); ++c)
        if (fans.find(c) == c) ++fanCount[faces[c / 3][c % 3]];
    for (int v = 0; v < vertexCount; ++v) {
        if (fanCount[v] < 2) continue;
        if (defects.nonManifoldVertices++ > 0) continue;
        defects.vertex = v;
        defects.vertexFans = fanCount[v];
    }
}

// Flood fill over edges with two faces.
void findOrientation(const std::vector<Triangle>& faces, const std::vector<EdgeUse>& uses, Defects& defects)
{
    std::vector<int> twin(3 * faces.size(), -1);
    forEachEdge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
        if (last - first == 1) defects.closed = false;
        if (last - first != 2) return;
        twin[first->h] = first[1].h;
        twin[first[1].h] = first->h;
    });
    const auto tail = [&](int h) { return faces[h / 3][h % 3]; };
    defects.flip.assign(faces.size(), false);
    std::vector<bool> seen(faces.size(), false);
    std::vector<int> queue;
    for (int seed = 0; seed < static_cast<int>(faces.size()); ++seed) {
        if (seen[seed]) continue;
        seen[seed] = true;
        queue.assign(1, seed);
        for (size_t at = 0; at < queue.size(); ++at)
            for (int h = 3 * queue[at]; h < 3 * queue[at] + 3; ++h) {
                if (twin[h] < 0) continue;
                const int f = h / 3, g = twin[h] / 3;
                const bool agree = tail(h) != tail(twin[h]); // the edge runs the other way in the neighbour
                const bool flip = defects.flip[f] != !agree;
                if (!seen[g]) {
                    seen[g] = true;
                    defects.flip[g] = flip;
                    queue.push_back(g);
                } else if (defects.flip[g] != flip && defects.orientable) {
                    defects.orientable = false;
                    defects.conflictA = tail(h);
                    defects.conflictB = faces[f][(h + 1) % 3];
                }
            }
    }
}

Defects findDefects(const std::vector<Triangle>& faces, const std::vector<EdgeUse>& uses, int vertexCount)
{
    Defects defects;
    int firstUse = 0;
    forEachEdge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
        if (last - first < 3) return;
        if (defects.nonManifoldEdges++ > 0 && first->h > firstUse) return;
        firstUse = first->h;
        defects.edgeA = faces[first->h / 3][first->h % 3];
        defects.edgeB = faces[first->h / 3][(first->h + 1) % 3];
        defects.edgeFaces = static_cast<int>(last - first);
    });
    findNonManifoldVertices(faces, vertexCount, uses, defects);
    findOrientation(faces, uses, defects);
    return defects;
}

/// Triangles under repair, and where they come from.
struct Triangles
{
    std::vector<Triangle> faces;
    int64_t repeatedVertex = 0; ///< removed
    int64_t duplicate = 0;      ///< removed
};

Triangles cleaned(const std::vector<Triangle>& faces)
{
    Triangles result;
    std::vector<std::pair<Triangle, int>> sorted;
    for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
        Triangle t = faces[f];
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
            ++result.repeatedVertex;
            continue;
        }
        std::sort(t.begin(), t.end());
        sorted.emplace_back(t, f);
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<bool> keep(faces.size(), false);
    for (size_t i = 0; i < sorted.size(); ++i) {
        if (i > 0 && sorted[i].first == sorted[i - 1].first)
            ++result.duplicate;
        else
            keep[sorted[i].second] = true;
    }
    for (size_t f = 0; f < faces.size(); ++f)
        if (keep[f]) result.faces.push_back(faces[f]);
    return result;
}

/// For every vertex the first one at the same position; itself for vertices no face refers to.
std::vector<int> firstAtPosition(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces)
{
    struct Hash
    {
        size_t operator()(const Vec3& p) const
        {
            uint64_t h = 0;
            for (double x : p) {
                h = (h ^ std::hash<double>()(x)) * 0x9e3779b97f4a7c15U; // std::hash maps -0 and 0 alike
                h ^= h >> 32;
            }
            return h;
        }
    };
    std::vector<bool> referenced(positions.size(), false);
    for (const Triangle& t : faces)
        for (int v : t) referenced[v] = true;
    std::vector<int> first(positions.size());
    std::iota(first.begin(), first.end(), 0);
    std::unordered_map<Vec3, int, Hash> seen;
    seen.reserve(positions.size());
    // NaN equals nothing, so such vertices stay apart.
    for (int v = 0; v < static_cast<int>(positions.size()); ++v)
        if (referenced[v] && positions[v].allFinite()) first[v] = seen.emplace(positions[v], v).first->second;
    return first;
}

std::vector<Triangle> relabelled(std::vector<Triangle> faces, const std::vector<int>& label)
{
    for (Triangle& t : faces)
        for (int& v : t) v = label[v];
    return faces;
}

std::string plural(int64_t count, const std::string& one, const std::string& many)
{
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// What welding would break, or nothing.
std::string harmOfWelding(const Triangles& before, const Triangles& after, int vertexCount)
{
    if (const int64_t n = after.repeatedVertex - before.repeatedVertex; n > 0)
        return plural(n, "face", "faces") + " with a repeated vertex";
    if (const int64_t n = after.duplicate - before.duplicate; n > 0)
        return plural(n, "duplicate face", "duplicate faces");
    const Defects was = findDefects(before.faces, sortedEdgeUses(before.faces), vertexCount);
    const Defects is = findDefects(after.faces, sortedEdgeUses(after.faces), vertexCount);
    if (const int64_t n = is.nonManifoldEdges - was.nonManifoldEdges; n > 0)
        return plural(n, "non-manifold edge", "non-manifold edges");
    if (const int64_t n = is.nonManifoldVertices - was.nonManifoldVertices; n > 0)
        return plural(n, "non-manifold vertex", "non-manifold vertices");
    if (was.orientable && !is.orientable) return "a surface without orientation";
    return {};
}

Triangles welded(const PolygonSoup& soup, const std::vector<Triangle>& triangles, Weld weld,
                 RepairReport& report)
{
    Triangles asIndexed = cleaned(triangles);
    if (weld == Weld::Never) return asIndexed;
    const std::vector<int> first = firstAtPosition(soup.positions, triangles);
    for (int v = 0; v < static_cast<int>(first.size()); ++v) report.repeatedPositions += first[v] != v;
    if (report.repeatedPositions == 0) return asIndexed;
    Triangles joined = cleaned(relabelled(triangles, first));
    if (weld == Weld::Auto && soup.indexed)
        report.weldRefusal = harmOfWelding(asIndexed, joined, static_cast<int>(first.size()));
    if (!report.weldRefusal.empty()) return asIndexed;
    report.weldedVertices = report.repeatedPositions;
    return joined;
}

/// Faces of every component, the largest first, else in file order. Connected means across edges: parts that
/// merely touch in a vertex are no surface together.
std::vector<std::vector<int>> components(const std::vector<Triangle>& faces, const std::vector<EdgeUse>& uses)
{
    DisjointSets sets(faces.size());
    forEachEdge(uses, [&sets](const EdgeUse* first, const EdgeUse* last) {
        for (const EdgeUse* use = first + 1; use < last; ++use) sets.unite(first->h / 3, use->h / 3);
    });
    std::vector<int> indexOf(faces.size(), -1);
    std::vector<std::vector<int>> result;
    for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
        int& index = indexOf[sets.find(f)];
        if (index < 0) {
            index = static_cast<int>(result.size());
            result.emplace_back();
        }
        result[index].push_back(f);
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const auto& a, const auto& b) { return a.size() > b.size(); });
    return result;
}

Error severalComponents(const std::vector<std::vector<int>>& parts, const RepairReport& report)
{
    std::string sizes;
    const size_t shown = std::min<size_t>(parts.size(), 5);
    for (size_t i = 0; i < shown; ++i) sizes += (i ? ", " : "") + std::to_string(parts[i].size());
    if (shown < parts.size()) sizes += ", ...";
    std::string message = std::to_string(parts.size()) + " connected components, with " + sizes +
                          " triangles; one is needed (the largest can be chosen)";
    if (!report.weldRefusal.empty())
        message += "; " + std::to_string(report.repeatedPositions) +
                   " repeated positions were not welded, which would make " + report.weldRefusal;
    return {ErrorKind::SeveralComponents, message};
}

std::string more(int64_t count, const std::string& one, const std::string& many)
{
    return count > 1 ? ", and " + std::to_string(count - 1) + " more such " + (count == 2 ? one : many) : "";
}

std::string place(const PolygonSoup& soup, int v)
{
    std::ostringstream text;
    const Vec3& p = soup.positions[v];
    text << " at (" << p[0] << ", " << p[1] << ", " << p[2] << ")";
    return text.str();
}

std::string edgeName(const PolygonSoup& soup, int a, int b)
{
    const std::string numbers =
        std::to_string(a + soup.firstNumber) + "-" + std::to_string(b + soup.firstNumber);
    return soup.indexed ? numbers
                        : numbers + place(soup, a) + " to" + place(soup, b).substr(3); // STL shows no numbers
}

Status finite(const PolygonSoup& soup, const std::vector<Triangle>& faces)
{
    std::vector<int> infinite;
    for (const Triangle& t : faces)
        for (int v : t)
            if (!soup.positions[v].allFinite()) infinite.push_back(v);
    if (infinite.empty()) return Done{};
    std::sort(infinite.begin(), infinite.end());
    infinite.erase(std::unique(infinite.begin(), infinite.end()), infinite.end());
    return Error{ErrorKind::NotFinite, "vertex " + std::to_string(infinite.front() + soup.firstNumber) +
                                           " is not finite" + place(soup, infinite.front()) +
                                           more(static_cast<int64_t>(infinite.size()), "vertex", "vertices")};
}

Status manifold(const PolygonSoup& soup, const Defects& defects)
{
    if (defects.nonManifoldEdges > 0)
        return Error{ErrorKind::NonManifoldEdge, "non-manifold edge " +
                                                     edgeName(soup, defects.edgeA, defects.edgeB) + ": " +
                                                     std::to_string(defects.edgeFaces) + " faces" +
                                                     more(defects.nonManifoldEdges, "edge", "edges")};
    if (defects.nonManifoldVertices > 0)
        return Error{ErrorKind::NonManifoldVertex,
                     "non-manifold vertex " + std::to_string(defects.vertex + soup.firstNumber) +
                         place(soup, defects.vertex) + ": " + std::to_string(defects.vertexFans) +
                         " fans of faces meet only there" +
                         more(defects.nonManifoldVertices, "vertex", "vertices")};
    if (!defects.orientable)
        return Error{ErrorKind::NotOrientable, "not orientable: the two faces at edge " +
                                                   edgeName(soup, defects.conflictA, defects.conflictB) +
                                                   " cannot agree on a side"};
    return Done{};
}

double signedVolume(const PolygonSoup& soup, const std::vector<Triangle>& faces)
{
    const Vec3 origin = soup.positions[faces[0][0]]; // near the surface: offsets far from zero cancel
    double volume = 0;
    for (const Triangle& t : faces)
        volume += (soup.positions[t[0]] - origin)
                      .dot((soup.positions[t[1]] - origin).cross(soup.positions[t[2]] - origin));
    return volume;
}

int64_t orient(const PolygonSoup& soup, std::vector<Triangle>& faces, std::vector<bool> flip, bool closed)
{
    auto flips = std::count(flip.begin(), flip.end(), true);
    if (flips == 0) return 0;
    const auto apply = [&] {
        for (size_t f = 0; f < faces.size(); ++f)
            if (flip[f]) std::swap(faces[f][1], faces[f][2]);
    };
    apply();
    const bool reverse =
        closed ? signedVolume(soup, faces) < 0 : 2 * flips > static_cast<int64_t>(faces.size());
    if (!reverse) return flips;
    flips = static_cast<int64_t>(faces.size()) - flips;
    flip.assign(faces.size(), true);
    apply();
    return flips;
}

/// The faces over their own vertices only, in the order of the file.
Mesh compacted(const PolygonSoup& soup, std::vector<Triangle> faces)
{
    std::vector<int> label(soup.positions.size(), -1);
    for (const Triangle& t : faces)
        for (int v : t) label[v] = 0;
    Mesh mesh;
    for (size_t v = 0; v < label.size(); ++v) {
        if (label[v] < 0) continue;
        label[v] = mesh.vertexCount();
        mesh.positions.push_back(soup.positions[v]);
    }
    mesh.faces = relabelled(std::move(faces), label);
    return mesh;
}

/// A triangle's corners in ascending order, and whether that turns it over.
std::pair<Triangle, bool> sortedCorners(const Triangle& t)
{
    Triangle sorted = t;
    std::sort(sorted.begin(), sorted.end());
    const int first = static_cast<int>(std::min_element(t.begin(), t.end()) - t.begin());
    return {sorted, t[(first + 1) % 3] > t[(first + 2) % 3]};
}

/// The file's triangles that became `faces`, and as these are oriented, over the vertices that the file gives
/// them, which welding may have joined: so that no vertex takes the attributes of another one.
AttributedSurface attributedSurface(const PolygonSoup& soup, const std::vector<Triangle>& triangles,
                                    const std::vector<Triangle>& faces, bool welded)
{
    std::vector<std::pair<Triangle, bool>> kept;
    for (const Triangle& t : faces) kept.push_back(sortedCorners(t));
    std::sort(kept.begin(), kept.end());
    const std::vector<Triangle> named =
        welded ? relabelled(triangles, firstAtPosition(soup.positions, triangles)) : triangles;
    AttributedSurface surface;
    std::vector<int> label(soup.positions.size(), -1), vertices;
    for (size_t f = 0; f < triangles.size(); ++f) {
        const auto [corners, turned] = sortedCorners(named[f]);
        const auto found = std::lower_bound(kept.begin(), kept.end(), std::pair(corners, false));
        if (found == kept.end() || found->first != corners) continue;
        Triangle& t = surface.mesh.faces.emplace_back(triangles[f]);
        if (found->second != turned) std::swap(t[1], t[2]);
        for (int& v : t) {
            if (label[v] < 0) {
                label[v] = static_cast<int>(vertices.size());
                vertices.push_back(v);
                surface.mesh.positions.push_back(soup.positions[v]);
            }
            v = label[v];
        }
    }
    surface.attributes = attributesOf(soup, vertices);
    return surface;
}

} // namespace

std::vector<Triangle> triangulate(const PolygonSoup& soup)
{
    PolygonTriangulator triangulator(soup);
    std::vector<Triangle> triangles;
    triangles.reserve(soup.corners.size() - std::min(soup.corners.size(), 2 * soup.faceCount()));
    for (size_t f = 0; f < soup.faceCount(); ++f) triangulator.append(soup.face(f), triangles);
    return triangles;
}

Result<MeshFile> repaired(const PolygonSoup& soup, const ReadOptions& options)
{
    MeshFile file;
    RepairReport& report = file.report;
    report.verticesRead = static_cast<int64_t>(soup.positions.size());
    report.facesRead = static_cast<int64_t>(soup.faceCount());
    report.trailingBytes = static_cast<int64_t>(soup.trailingBytes);
    report.lastLineOpen = soup.lastLineOpen;
    for (size_t f = 0; f < soup.faceCount(); ++f) report.polygonsSplit += soup.face(f).size() > 3;

    const int vertexCount = static_cast<int>(soup.positions.size());
    const std::vector<Triangle> triangles = triangulate(soup);
    std::vector<bool> referenced(soup.positions.size(), false);
    for (const Triangle& t : triangles)
        for (int v : t) referenced[v] = true;
    report.unreferencedVertices = std::count(referenced.begin(), referenced.end(), false);

    Triangles kept = welded(soup, triangles, options.weld, report);
    report.repeatedVertexFaces = kept.repeatedVertex;
    report.duplicateFaces = kept.duplicate;
    std::vector<Triangle> faces = std::move(kept.faces);
    if (faces.empty()) return Error{ErrorKind::EmptyMesh, "no face has three different vertices"};

    std::vector<EdgeUse> uses = sortedEdgeUses(faces);
    const std::vector<std::vector<int>> parts = components(faces, uses);
    report.components = static_cast<int64_t>(parts.size());
    if (!options.largestComponent)
        if (const Status status = finite(soup, faces); !status) return status.error();
    if (parts.size() > 1) {
        if (!options.largestComponent) return severalComponents(parts, report);
        std::vector<Triangle> chosen;
        for (int f : parts.front()) chosen.push_back(faces[f]);
        report.droppedFaces = static_cast<int64_t>(faces.size() - chosen.size());
        faces = std::move(chosen);
        uses = sortedEdgeUses(faces);
    }

    if (const Status status = finite(soup, faces); !status) return status.error();
    Defects defects = findDefects(faces, uses, vertexCount);
    if (const Status status = manifold(soup, defects); !status) return status.error();
    report.flippedFaces = orient(soup, faces, std::move(defects.flip), defects.closed);
    for (const Triangle& t : faces) {
        const Vec3& p = soup.positions[t[0]];
        report.zeroAreaFaces += (soup.positions[t[1]] - p).cross(soup.positions[t[2]] - p).isZero(0);
    }
    if (!soup.columns.empty())
        file.attributed = attributedSurface(soup, triangles, faces, report.weldedVertices > 0);
    file.mesh = compacted(soup, std::move(faces));
    return file;
}

} // namespace gimg

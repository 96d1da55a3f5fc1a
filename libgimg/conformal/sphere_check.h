#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

namespace gimg {

/// Whether a mesh is one closed, oriented, manifold surface of genus 0, of faces with an area. Errors:
/// EmptyMesh, BadArgument (indices, a vertex in no face), NotFinite, ZeroAreaFace, NonManifoldEdge,
/// NonManifoldVertex, SeveralComponents, NotClosed, WrongGenus.
Status checkSphere(const Mesh& mesh);

} // namespace gimg

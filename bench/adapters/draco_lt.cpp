// Simplification by Lindstrom and Turk, then Draco: the strongest of the peers that code meshes.
#include "draco_codec.h"
#include "mesh_peer.h"

namespace gimg::adapter {

std::unique_ptr<Adapter> makeAdapter()
{
    const Description description = {"draco-lt", "Lindstrom-Turk + Draco",        Input::Mesh, Side::Peer,
                                     "draco",    {"libcgal-dev", "libdraco-dev"}, {},          false};
#ifdef GIMG_MISSING
    return makeMissing(description, {GIMG_MISSING});
#else
    return makeMeshPeer({description, lindstromTurkLadder, dracoCodec(), timeDraco});
#endif
}

} // namespace gimg::adapter

#pragma once

#include "gimg/distance.h"
#include "gimg/image_io.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// An adapter makes one coder, ours or a peer's, look like every other to gimrd. Each is one file in this
/// folder that defines makeAdapter(), and becomes a program of its own, so that a coder that crashes takes
/// only its own points along. README.md beside this file has the protocol that the program speaks.
namespace gimg::adapter {

/// What an adapter codes.
enum class Input
{
    Mesh,  ///< the mesh itself
    Image, ///< a geometry image of it, without its seam: the decoded grid is judged with open borders
};

/// Who wrote the coder: ours are chosen with --coders, others with --peers.
enum class Side
{
    Ours,
    Peer,
};

struct Description
{
    std::string name;  ///< as on the command line: lower case, digits, hyphens
    std::string title; ///< as in legends and tables
    Input input = Input::Mesh;
    Side side = Side::Peer;
    std::string codec;                 ///< what `time` measures, the key of `gimrd bench`: "draco"
    std::vector<std::string> packages; ///< Debian packages that this adapter needs at build or run time
    std::vector<std::string> missing;  ///< those of them that are not there; empty: the adapter can run
    bool usesGrid = false;             ///< whether `grid` of a request matters
};

/// What is to be coded. Of `mesh` and `image` the one that Description::input names is set, the other empty.
struct Subject
{
    Mesh mesh;
    FloatImage image; ///< square
    int grid = 0;     ///< samples a side asked for; 0: the coder chooses
    int threads = 0;  ///< 0: one a core
};

/// What came out for one size. Exactly one of `mesh` and `image` is filled, as Description::input says.
struct Coded
{
    std::vector<std::uint8_t> file; ///< all bytes that a receiver needs
    std::string extension;          ///< of such a file, "drc"
    Mesh mesh;                      ///< what a decoder made of `file`
    FloatImage image;
    nlohmann::ordered_json settings =
        nlohmann::ordered_json::object(); ///< what was chosen: triangles, bits, ...
};

/// Times of coding a subject whole, without any search, in milliseconds.
struct Times
{
    std::size_t bytes = 0;
    std::vector<double> encode;
    std::vector<double> decode; ///< from bytes in memory to the mesh or image in memory
    std::string note;           ///< what the times include that others do not: "starts a process"
};

class Adapter
{
public:
    virtual ~Adapter() = default;

    virtual Description describe() const = 0;

    /// Codes the subject for each size in turn: the best file of at most `sizes[i]` bytes that this coder can
    /// make, which for a small subject may be far smaller. Calls `done` once for each size, in the order
    /// given, with an Error of kind TargetUnreachable where no file is so small. Any other error ends the
    /// run.
    virtual Status encode(const Subject& subject, const std::vector<std::size_t>& sizes,
                          const std::function<void(std::size_t size, Result<Coded>)>& done) = 0;

    /// Codes and decodes the subject whole `runs` times, single thread where the coder lets one choose.
    /// @param size  what an image coder aims at; mesh coders code all triangles (Draco: 12 bits, -cl 10)
    virtual Result<Times> time(const Subject& subject, std::size_t size, int runs) = 0;
};

/// Defined by the adapter's file.
std::unique_ptr<Adapter> makeAdapter();

/// Whether a program of this name is on PATH.
bool onPath(const std::string& program);

} // namespace gimg::adapter

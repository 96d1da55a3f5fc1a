#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <utility>

namespace gimg {

/// Why a call gave no result. One kind for each thing a caller can react to.
enum class ErrorKind
{
    FileNotReadable,   ///< the file cannot be opened or read
    FileNotWritable,   ///< the file cannot be created or written
    FormatUnknown,     ///< no reader or writer for this file name extension
    FileTruncated,     ///< the file ends before what its header promises
    FileCorrupt,       ///< the file contradicts its own format
    EmptyMesh,         ///< no face is left
    NotFinite,         ///< a NaN or infinite coordinate
    NonManifoldEdge,   ///< more than two faces on an edge
    NonManifoldVertex, ///< the faces at a vertex form more than one fan
    NotOrientable,     ///< no consistent orientation exists
    SeveralComponents, ///< more than one connected component
    NotADisk,          ///< a disk was required
    NotClosed,         ///< a surface without boundary was required
    WrongGenus,        ///< the genus is not one that the call is for
    ZeroAreaFace,      ///< a triangle without an area, or as thin as a double can tell
    FlippedTriangle,   ///< no embedding without flipped triangles was found
    TargetUnreachable, ///< no file meets the requested size or quality
    BadArgument,       ///< a parameter is outside its documented range
    CodecFailure,      ///< the decoder refused the bytes
    SolverFailure,     ///< a linear system could not be solved
};

/// What went wrong, in one line fit for a terminal; names the element where there is one.
struct Error
{
    ErrorKind kind;
    std::string message;
};

/// A value or an Error. Nothing in gimg throws across a public border.
template <class T> class [[nodiscard]] Result
{
public:
    Result(T value) : value_(std::move(value)) {}
    Result(Error error) : error_(std::move(error)) {}

    bool ok() const { return value_.has_value(); }
    explicit operator bool() const { return ok(); }

    T& value() { return assert(ok()), *value_; }
    const T& value() const { return assert(ok()), *value_; }
    T& operator*() { return value(); }
    const T& operator*() const { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    const Error& error() const { return assert(!ok()), error_; }

private:
    std::optional<T> value_;
    Error error_{};
};

/// Success or an Error, for calls that return nothing.
struct Done
{
};
using Status = Result<Done>;

} // namespace gimg

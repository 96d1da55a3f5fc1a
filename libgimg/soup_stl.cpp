// Stereolithography: text or binary facets, each with three vertices of its own. The facet normal is not
// needed.
#include "soup_parsers.h"
#include "text_scan.h"

#include <bit>
#include <cstring>

namespace gimg {

namespace {

constexpr size_t kHeaderSize = 84;
constexpr size_t kFacetSize = 50;

uint32_t littleEndian32(const char* bytes)
{
    uint32_t value = 0;
    for (int k = 3; k >= 0; --k) value = value << 8 | static_cast<unsigned char>(bytes[k]);
    return value;
}

Result<PolygonSoup> parseBinary(std::string_view bytes)
{
    if (bytes.size() < kHeaderSize)
        return Error{ErrorKind::FileTruncated, "the file ends within the header of 84 bytes"};
    const size_t facets = littleEndian32(bytes.data() + 80);
    const size_t held = (bytes.size() - kHeaderSize) / kFacetSize;
    if (held < facets)
        return Error{ErrorKind::FileTruncated, "the file ends within facet " + std::to_string(held) +
                                                   ", the header promises " + std::to_string(facets) +
                                                   " of them"};
    PolygonSoup soup;
    soup.indexed = false;
    soup.trailingBytes = bytes.size() - kHeaderSize - facets * kFacetSize;
    soup.positions.reserve(3 * facets);
    soup.corners.reserve(3 * facets);
    soup.faceStart.reserve(facets + 1);
    for (size_t f = 0; f < facets; ++f) {
        const char* at = bytes.data() + kHeaderSize + f * kFacetSize + 12; // past the normal
        for (int k = 0; k < 3; ++k) {
            Vec3 p;
            for (double& x : p) {
                x = double{std::bit_cast<float>(littleEndian32(at))};
                at += 4;
            }
            soup.corners.push_back(static_cast<int>(soup.positions.size()));
            soup.positions.push_back(p);
        }
        soup.endFace();
    }
    return soup;
}

class TextParser
{
public:
    explicit TextParser(std::string_view text) : scan_(text) { soup_.indexed = false; }

    // solid [name] { facet normal x y z  outer loop  { vertex x y z }  endloop  endfacet } endsolid [name]
    Result<PolygonSoup> parse()
    {
        for (std::string_view t = scan_.token(); !t.empty(); t = scan_.token()) {
            if (!equalsIgnoringCase(t, "solid")) return failure();
            scan_.nextLine();
            for (t = scan_.token(); equalsIgnoringCase(t, "facet"); t = scan_.token())
                if (!facet()) return failure();
            if (!equalsIgnoringCase(t, "endsolid")) return failure();
            scan_.nextLine();
        }
        return std::move(soup_);
    }

private:
    bool word(std::string_view expected) { return equalsIgnoringCase(scan_.token(), expected); }

    bool facet()
    {
        if (!word("normal")) return false;
        for (int k = 0; k < 3; ++k) scan_.token(); // not looked at: writers leave anything here
        if (!word("outer") || !word("loop")) return false;
        std::string_view t = scan_.token();
        for (; equalsIgnoringCase(t, "vertex"); t = scan_.token()) {
            Vec3 p;
            for (double& x : p) {
                const std::optional<double> value = number(scan_.token());
                if (!value) return false;
                x = *value;
            }
            soup_.corners.push_back(static_cast<int>(soup_.positions.size()));
            soup_.positions.push_back(p);
        }
        if (soup_.corners.size() < soup_.faceStart.back() + 3) return false;
        soup_.endFace();
        return equalsIgnoringCase(t, "endloop") && word("endfacet");
    }

    Error failure() const
    {
        const std::string facet = "facet " + std::to_string(soup_.faceCount());
        if (scan_.onLastLine())
            return {ErrorKind::FileTruncated, "the file ends at " + facet + ", before 'endsolid'"};
        return {ErrorKind::FileCorrupt,
                "line " + std::to_string(scan_.line()) + ": " + facet + " is malformed"};
    }

    TextScanner scan_;
    PolygonSoup soup_;
};

// Binary files may start with "solid" as well, so the size decides first, and then the second line.
bool isText(std::string_view bytes)
{
    if (bytes.size() >= kHeaderSize &&
        bytes.size() - kHeaderSize == kFacetSize * size_t{littleEndian32(bytes.data() + 80)})
        return false;
    TextScanner scan(bytes);
    if (!equalsIgnoringCase(scan.token(), "solid")) return false;
    scan.nextLine();
    const std::string_view second = scan.token();
    return second.empty() || equalsIgnoringCase(second, "facet") || equalsIgnoringCase(second, "endsolid");
}

} // namespace

Result<PolygonSoup> parseStl(std::string_view bytes)
{
    return isText(bytes) ? TextParser(bytes).parse() : parseBinary(bytes);
}

} // namespace gimg

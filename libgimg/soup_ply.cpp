// PLY 1.0, text and binary of either byte order. Elements and properties other than the vertices' numbers and
// the vertex indices are passed over, wherever they stand.
#include "soup_parsers.h"
#include "text_scan.h"

#include <algorithm>
#include <bit>
#include <climits>
#include <cmath>

namespace gimg {

namespace {

enum class Scalar
{
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Float32,
    Float64,
};

std::optional<Scalar> scalarType(std::string_view name)
{
    constexpr std::string_view names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                             {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                             {"float", "float32"}, {"double", "float64"}};
    for (int i = 0; i < 8; ++i)
        if (name == names[i][0] || name == names[i][1]) return static_cast<Scalar>(i);
    return std::nullopt;
}

size_t scalarSize(Scalar type)
{
    constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<int>(type)];
}

struct Property
{
    std::string name;
    Scalar type;
    std::optional<Scalar> countType; // of a list
};

struct Element
{
    std::string name;
    int64_t count;
    std::vector<Property> properties;
};

enum class Storage
{
    Text,
    LittleEndian,
    BigEndian,
};

struct Header
{
    Storage storage = Storage::Text;
    std::vector<Element> elements;
    size_t size = 0;
};

/// What stopped a read.
enum class Stop
{
    None,
    Ended,
    Malformed,
};

class TextBody
{
public:
    explicit TextBody(std::string_view text) : scan_(text) {}

    Stop read(Scalar, double& value)
    {
        const std::string_view t = scan_.token();
        if (t.empty()) return Stop::Ended;
        const std::optional<double> parsed = number(t);
        if (!parsed)
            return scan_.remaining() == 0 ? Stop::Ended : Stop::Malformed; // the last token may be half a one
        value = *parsed;
        return Stop::None;
    }
    // A scalar takes a character and a separator, which the very last one may lack.
    bool mayHold(int64_t scalars, size_t) const
    {
        return scalars <= static_cast<int64_t>(scan_.remaining() / 2 + 1);
    }
    size_t trailing()
    {
        const std::string_view t = scan_.token();
        return t.size() + (t.empty() ? 0 : scan_.remaining());
    }

private:
    TextScanner scan_;
};

template <bool kBigEndian> class BinaryBody
{
public:
    explicit BinaryBody(std::string_view bytes) : bytes_(bytes) {}

    Stop read(Scalar type, double& value)
    {
        const size_t size = scalarSize(type);
        if (bytes_.size() < size) return Stop::Ended;
        uint64_t bits = 0;
        for (size_t k = 0; k < size; ++k)
            bits = bits << 8 | static_cast<unsigned char>(bytes_[kBigEndian ? k : size - 1 - k]);
        bytes_.remove_prefix(size);
        switch (type) {
        case Scalar::Int8:
            value = static_cast<int8_t>(bits);
            break;
        case Scalar::Int16:
            value = static_cast<int16_t>(bits);
            break;
        case Scalar::Int32:
            value = static_cast<int32_t>(bits);
            break;
        case Scalar::Float32:
            value = double{std::bit_cast<float>(static_cast<uint32_t>(bits))};
            break;
        case Scalar::Float64:
            value = std::bit_cast<double>(bits);
            break;
        default:
            value = static_cast<double>(bits);
            break;
        }
        return Stop::None;
    }
    bool mayHold(int64_t, size_t bytes) const { return bytes <= bytes_.size(); }
    size_t trailing() const { return bytes_.size(); }

private:
    std::string_view bytes_;
};

Result<Header> parseHeader(std::string_view bytes)
{
    const Error ended{ErrorKind::FileTruncated, "the file ends within the header"};
    const auto corrupt = [](size_t line, const std::string& what) {
        return Error{ErrorKind::FileCorrupt, "line " + std::to_string(line) + ": " + what};
    };
    TextScanner scan(bytes);
    if (scan.lineToken() != "ply") return Error{ErrorKind::FileCorrupt, "not a PLY file"};
    Header header;
    bool formatKnown = false;
    for (;;) {
        if (!scan.nextLine()) return ended;
        const std::string_view key = scan.lineToken();
        if (key == "end_header") break;
        if (key == "format") {
            const std::string_view storage = scan.lineToken();
            if (storage == "ascii")
                header.storage = Storage::Text;
            else if (storage == "binary_little_endian")
                header.storage = Storage::LittleEndian;
            else if (storage == "binary_big_endian")
                header.storage = Storage::BigEndian;
            else
                return corrupt(scan.line(), "unknown format '" + std::string(storage.substr(0, 40)) + "'");
            if (scan.lineToken() != "1.0") return corrupt(scan.line(), "only version 1.0 is known");
            formatKnown = true;
        } else if (key == "element") {
            const std::string name(scan.lineToken());
            const std::optional<int64_t> count = integer(scan.lineToken());
            if (!count || *count < 0 || *count > UINT32_MAX) return corrupt(scan.line(), "bad element count");
            for (const Element& e : header.elements)
                if (e.name == name) return corrupt(scan.line(), "element declared twice");
            header.elements.push_back({name, *count, {}});
        } else if (key == "property") {
            if (header.elements.empty()) return corrupt(scan.line(), "a property before any element");
            std::string_view type = scan.lineToken();
            std::optional<Scalar> countType;
            if (type == "list") {
                countType = scalarType(scan.lineToken());
                if (!countType) return corrupt(scan.line(), "unknown property type");
                type = scan.lineToken();
            }
            const std::optional<Scalar> valueType = scalarType(type);
            if (!valueType) return corrupt(scan.line(), "unknown property type");
            header.elements.back().properties.push_back(
                {std::string(scan.lineToken()), *valueType, countType});
        } else if (!key.empty() && key != "comment" && key != "obj_info") {
            return corrupt(scan.line(), "unknown header keyword '" + std::string(key.substr(0, 40)) + "'");
        }
    }
    if (!formatKnown) return Error{ErrorKind::FileCorrupt, "the header names no format"};
    if (!scan.nextLine())
        header.size = bytes.size();
    else
        header.size = bytes.size() - scan.remaining();
    return header;
}

template <class Body> class BodyParser
{
public:
    explicit BodyParser(std::string_view bytes) : body_(bytes) {}

    Result<PolygonSoup> parse(const std::vector<Element>& elements)
    {
        for (const Element& e : elements) {
            if (e.properties.empty()) continue;
            if (const std::string missing = bind(e); !missing.empty())
                return Error{ErrorKind::FileCorrupt, "element " + e.name + " has no " + missing};
            // A list takes at least its count. Checked here, so that what follows may reserve.
            size_t size = 0;
            for (const Property& p : e.properties) size += scalarSize(p.countType.value_or(p.type));
            const int64_t scalars = e.count * static_cast<int64_t>(e.properties.size());
            if (!body_.mayHold(scalars, static_cast<size_t>(e.count) * size))
                return Error{ErrorKind::FileTruncated, "the header promises " + std::to_string(e.count) +
                                                           " of element " + e.name +
                                                           ", more than the file can hold"};
            if (isVertex_) {
                soup_.positions.reserve(static_cast<size_t>(e.count));
                for (VertexColumn& column : soup_.columns)
                    column.values.reserve(static_cast<size_t>(e.count));
            }
            if (isFace_) {
                soup_.corners.reserve(3 * static_cast<size_t>(e.count));
                soup_.faceStart.reserve(static_cast<size_t>(e.count) + 1);
            }
            for (int64_t i = 0; i < e.count; ++i) {
                const Stop stop = element(e);
                if (stop == Stop::None) continue;
                const std::string name = e.name + " " + std::to_string(i);
                if (stop == Stop::Malformed) return Error{ErrorKind::FileCorrupt, name + " is malformed"};
                return Error{ErrorKind::FileTruncated, "the file ends within " + name +
                                                           ", the header promises " +
                                                           std::to_string(e.count) + " of them"};
            }
        }
        soup_.trailingBytes = body_.trailing();
        return std::move(soup_);
    }

private:
    /// Finds the properties to keep. Returns the name of one that is missing.
    std::string bind(const Element& e)
    {
        isVertex_ = e.name == "vertex";
        isFace_ = e.name == "face";
        columnOf_.assign(e.properties.size(), kNoColumn);
        std::fill(axis_, axis_ + 3, size_t{0});
        indices_ = e.properties.size();
        bool found[3] = {};
        for (size_t p = 0; p < e.properties.size(); ++p) {
            const Property& property = e.properties[p];
            if (isVertex_ && !property.countType && !isAxis(property.name)) {
                columnOf_[p] = soup_.columns.size();
                soup_.columns.push_back({property.name, sampleType(property.type), {}});
            }
            for (int k = 0; k < 3; ++k)
                if (isVertex_ && !property.countType &&
                    property.name == std::string(1, static_cast<char>('x' + k))) {
                    axis_[k] = p;
                    found[k] = true;
                }
            if (isFace_ && property.countType &&
                (property.name == "vertex_indices" || property.name == "vertex_index"))
                indices_ = p;
        }
        if (isFace_ && indices_ == e.properties.size()) return "list vertex_indices";
        for (int k = 0; k < 3; ++k)
            if (isVertex_ && !found[k]) return "property " + std::string(1, static_cast<char>('x' + k));
        return {};
    }

    Stop element(const Element& e)
    {
        Vec3 position = Vec3::Zero();
        for (size_t p = 0; p < e.properties.size(); ++p) {
            const Property& property = e.properties[p];
            double value = 0;
            if (!property.countType) {
                if (const Stop stop = body_.read(property.type, value); stop != Stop::None) return stop;
                for (int k = 0; k < 3; ++k)
                    if (axis_[k] == p) position[k] = value;
                if (columnOf_[p] != kNoColumn)
                    soup_.columns[columnOf_[p]].values.push_back(asSample(property.type, value));
                continue;
            }
            if (const Stop stop = body_.read(*property.countType, value); stop != Stop::None) return stop;
            if (!(value >= 0 && value <= UINT32_MAX) || value != std::floor(value)) return Stop::Malformed;
            const bool keep = isFace_ && p == indices_;
            for (int64_t i = 0, n = static_cast<int64_t>(value); i < n; ++i) {
                if (const Stop stop = body_.read(property.type, value); stop != Stop::None) return stop;
                if (!keep) continue;
                if (!(value >= INT_MIN && value <= INT_MAX) || value != std::floor(value))
                    return Stop::Malformed;
                soup_.corners.push_back(static_cast<int>(value));
            }
            if (keep) soup_.endFace();
        }
        if (isVertex_) soup_.positions.push_back(position);
        return Stop::None;
    }

    static constexpr size_t kNoColumn = SIZE_MAX;

    static bool isAxis(const std::string& name) { return name == "x" || name == "y" || name == "z"; }

    static gim_sample_type sampleType(Scalar type)
    {
        return type == Scalar::Uint8 ? GIM_U8 : type == Scalar::Uint16 ? GIM_U16 : GIM_F32;
    }

    // Text may hold anything under the name of a type.
    static float asSample(Scalar type, double value)
    {
        const double most = type == Scalar::Uint8 ? 255 : 65535;
        if (sampleType(type) == GIM_F32) return static_cast<float>(value);
        return value >= 0 ? static_cast<float>(std::min(std::floor(value), most)) : 0.0f;
    }

    Body body_;
    PolygonSoup soup_;
    std::vector<size_t> columnOf_; // by property of the element at hand
    bool isVertex_ = false;
    bool isFace_ = false;
    size_t axis_[3] = {};
    size_t indices_ = 0;
};

} // namespace

Result<PolygonSoup> parsePly(std::string_view bytes)
{
    const Result<Header> header = parseHeader(bytes);
    if (!header) return header.error();
    const std::string_view body = bytes.substr(header->size);
    switch (header->storage) {
    case Storage::LittleEndian:
        return BodyParser<BinaryBody<false>>(body).parse(header->elements);
    case Storage::BigEndian:
        return BodyParser<BinaryBody<true>>(body).parse(header->elements);
    case Storage::Text:
        break;
    }
    Result<PolygonSoup> soup = BodyParser<TextBody>(body).parse(header->elements);
    if (soup) soup->lastLineOpen = bytes.back() != '\n' && bytes.back() != '\r';
    return soup;
}

} // namespace gimg

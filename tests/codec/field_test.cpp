#include "codec/attribute_header.h"
#include "codec/field_set.h"
#include "format/writer.h"
#include "sample_images.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace gimg::codec {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Colours that change smoothly over the torus, and a fourth channel that does not change.
std::vector<float> torusColors(std::uint32_t grid)
{
    const std::vector<float> normals = samples::torusNormals(grid);
    std::vector<float> colors;
    for (std::size_t k = 0; k < normals.size(); k += 3) {
        for (unsigned c = 0; c < 3; ++c)
            colors.push_back(std::floor(127.5f + 120 * normals[k + c] * normals[k + 2]));
        colors.push_back(200);
    }
    return colors;
}

struct TorusSource
{
    std::vector<float> xyz = samples::torusImage(65), normals = samples::torusNormals(129),
                       colors = torusColors(65), uv, bones;
    Source source;

    TorusSource()
    {
        for (std::uint32_t k = 0; k < 33 * 33; ++k)
            for (const std::uint32_t at : {k % 33, k / 33}) uv.push_back(static_cast<float>(at) / 32);
        samples::Dice dice(1);
        for (std::uint32_t k = 0; k < 17 * 17; ++k) bones.push_back(static_cast<float>(dice.below(65536)));
        source.grid = 65;
        source.seam = samples::torusSeam(9);
        source.xyz = xyz;
    }

    void addAll()
    {
        source.normalGrid = 129;
        source.normals = normals;
        source.attributes.push_back({"color", 65, 4, GIM_U8, true, true, false, colors});
        source.attributes.push_back({"uv", 33, 2, GIM_F32, false, false, false, uv});
        source.attributes.push_back({"bones", 17, 1, GIM_U16, false, false, true, bones});
    }
};

gim_attribute attributeOf(const Bytes& bytes, std::uint32_t index)
{
    gim_attribute attribute{};
    attribute.size = sizeof attribute;
    EXPECT_EQ(gim_read_attribute(bytes.data(), bytes.size(), nullptr, index, &attribute), GIM_OK);
    return attribute;
}

template <class T> std::vector<T> decodedAttribute(const Bytes& bytes, std::uint32_t index)
{
    const gim_info info = samples::probed(bytes);
    Bytes work(gim_workspace_size(&info));
    std::vector<T> out(attributeOf(bytes, index).decoded_bytes / sizeof(T));
    EXPECT_EQ(gim_decode_attribute(bytes.data(), bytes.size(), nullptr, index, work.data(), work.size(),
                                   out.data()),
              GIM_OK);
    return out;
}

template <class T> double largestDifference(const std::vector<T>& decoded, const std::vector<float>& exact)
{
    EXPECT_EQ(decoded.size(), exact.size());
    double worst = 0;
    for (std::size_t k = 0; k < exact.size(); ++k)
        worst = std::max(worst, std::abs(static_cast<double>(decoded[k]) - static_cast<double>(exact[k])));
    return worst;
}

EncodedFile fileOf(const Encoder& encoder, std::size_t target)
{
    auto made = encoder.encodeToBytes(target);
    if (const auto* error = std::get_if<EncodeError>(&made)) throw std::runtime_error(error->message);
    return std::get<EncodedFile>(made);
}

Encoder prepared(const Source& source)
{
    auto made = Encoder::prepare(source);
    if (const auto* error = std::get_if<EncodeError>(&made)) throw std::runtime_error(error->message);
    return std::get<Encoder>(made);
}

TEST(Attributes, ComeBackWithWhatWasSaidOfThem)
{
    TorusSource torus;
    torus.addAll();
    const Bytes bytes = fileOf(prepared(torus.source), 3600).bytes;
    EXPECT_LE(bytes.size(), 4000u);
    const gim_info info = samples::probed(bytes);
    ASSERT_EQ(info.attributes, 3u);
    EXPECT_EQ(info.normal_coding, GIM_CODING_FIELD);
    EXPECT_EQ(info.container_bytes + info.seam_bytes + info.geometry_bytes + info.normal_bytes +
                  info.attribute_bytes,
              bytes.size());
    const gim_attribute color = attributeOf(bytes, 0), uv = attributeOf(bytes, 1),
                        bones = attributeOf(bytes, 2);
    EXPECT_STREQ(color.name, "color");
    EXPECT_EQ(color.grid, 65u);
    EXPECT_EQ(color.channels, 4u);
    EXPECT_EQ(color.type, GIM_U8);
    EXPECT_EQ(color.coding, GIM_CODING_FIELD);
    EXPECT_EQ(color.glued, 1u);
    EXPECT_EQ(color.normalized, 1u);
    EXPECT_STREQ(uv.name, "uv");
    EXPECT_EQ(uv.glued, 0u);
    EXPECT_EQ(uv.decoded_bytes, 33u * 33 * 2 * 4);
    EXPECT_EQ(bones.coding, GIM_CODING_FLOAT);
    EXPECT_EQ(bones.decoded_bytes, 17u * 17 * 2);
    EXPECT_EQ(color.coded_bytes + uv.coded_bytes + bones.coded_bytes, info.attribute_bytes);

    EXPECT_LE(largestDifference(decodedAttribute<std::uint8_t>(bytes, 0), torus.colors), 4);
    EXPECT_LE(largestDifference(decodedAttribute<float>(bytes, 1), torus.uv), 0.01);
    EXPECT_EQ(largestDifference(decodedAttribute<std::uint16_t>(bytes, 2), torus.bones), 0);

    gim_attribute none{};
    none.size = sizeof none;
    EXPECT_EQ(gim_read_attribute(bytes.data(), bytes.size(), nullptr, 3, &none), GIM_MISUSE);
    none.size = 8;
    EXPECT_EQ(gim_read_attribute(bytes.data(), bytes.size(), nullptr, 0, &none), GIM_MISUSE);
}

TEST(Attributes, GluedSamplesAgreeAndOpenOnesMayJump)
{
    TorusSource torus;
    torus.addAll();
    // The colours get an error where two sides are glued: the two meet in the middle.
    for (std::uint32_t i = 0; i < 65; ++i) torus.colors[4 * (64 * 65 + i)] = 255;
    const Bytes bytes = fileOf(prepared(torus.source), 3600).bytes;
    const auto colors = decodedAttribute<std::uint8_t>(bytes, 0);
    const auto uv = decodedAttribute<float>(bytes, 1);
    for (std::uint32_t i = 0; i < 65; ++i)
        for (std::uint32_t c = 0; c < 4; ++c) EXPECT_EQ(colors[4 * i + c], colors[4 * (64 * 65 + i) + c]);
    EXPECT_NEAR(uv[2 * 16 + 1], 0, 0.01);
    EXPECT_NEAR(uv[2 * (32 * 33 + 16) + 1], 1, 0.01);
}

TEST(Attributes, AreLosslessInRawFilesAndWhereAskedFor)
{
    TorusSource torus;
    torus.addAll();
    for (const gim_coding coding : {GIM_CODING_RAW12, GIM_CODING_FLOAT}) {
        const Bytes bytes = samples::encoded(torus.source, {coding, 0, 0});
        EXPECT_EQ(largestDifference(decodedAttribute<std::uint8_t>(bytes, 0), torus.colors), 0);
        EXPECT_EQ(largestDifference(decodedAttribute<float>(bytes, 1), torus.uv), 0);
        EXPECT_EQ(largestDifference(decodedAttribute<std::uint16_t>(bytes, 2), torus.bones), 0);
    }
}

TEST(Attributes, IntegersAreClampedToTheirType)
{
    TorusSource torus;
    // Steps as high as the type is wide, coded coarsely: they overshoot on both sides.
    std::vector<float> edges(65 * 65);
    for (std::uint32_t k = 0; k < edges.size(); ++k) edges[k] = k % 65 > 20 && k % 65 < 40 ? 65535.0f : 0.0f;
    torus.source.attributes.push_back({"edges", 65, 1, GIM_U16, true, true, false, edges});
    Settings settings{GIM_CODING_SURFACE, 0.05f, 0};
    settings.attributeStep = 0.3f;
    const auto decoded = decodedAttribute<std::uint16_t>(samples::encoded(torus.source, settings), 0);
    EXPECT_EQ(*std::min_element(decoded.begin(), decoded.end()), 0);
    EXPECT_EQ(*std::max_element(decoded.begin(), decoded.end()), 65535);
    EXPECT_LT(decoded[65 * 30 + 10], 20000);
    EXPECT_GT(decoded[65 * 30 + 30], 45000);
}

TEST(Attributes, GetTheSharesThatAreDocumented)
{
    TorusSource torus;
    const std::vector<float> noise = samples::bumpyImage(65, 3), more = samples::bumpyImage(65, 4);
    torus.source.attributes.push_back({"a", 65, 3, GIM_F32, false, false, false, noise});
    torus.source.attributes.push_back({"b", 65, 3, GIM_F32, false, false, false, more});
    const std::vector<float> geometry = samples::bumpyImage(65, 5);
    torus.source.xyz = geometry;
    const Bytes bytes = fileOf(prepared(torus.source), 8000).bytes;
    for (std::uint32_t k = 0; k < 2; ++k)
        EXPECT_NEAR(static_cast<double>(attributeOf(bytes, k).coded_bytes), 8000.0 / 8, 70);
    for (const char* name : {"c", "d", "e", "f"})
        torus.source.attributes.push_back({name, 65, 3, GIM_F32, false, false, false, noise});
    const Bytes many = fileOf(prepared(torus.source), 8000).bytes;
    EXPECT_NEAR(static_cast<double>(samples::probed(many).attribute_bytes), 4000, 180);
}

TEST(Attributes, SourcesThatCannotBeWrittenAreRefused)
{
    const auto faultOf = [](const auto& spoil) {
        TorusSource torus;
        torus.addAll();
        spoil(torus);
        auto made = Encoder::prepare(torus.source);
        const auto* error = std::get_if<EncodeError>(&made);
        return error == nullptr ? std::string() : error->message;
    };
    EXPECT_EQ(faultOf([](TorusSource&) {}), "");
    EXPECT_NE(faultOf([](TorusSource& t) { t.source.attributes[0].name = ""; }), "");
    EXPECT_NE(faultOf([](TorusSource& t) { t.source.attributes[0].name = "a\nb"; }), "");
    EXPECT_NE(faultOf([](TorusSource& t) { t.source.attributes[0].name = "uv"; }), "");
    EXPECT_NE(faultOf([](TorusSource& t) { t.source.attributes[0].channels = 17; }), "");
    EXPECT_NE(faultOf([](TorusSource& t) { t.colors[5] = 0.5f; }), "");
    EXPECT_NE(faultOf([](TorusSource& t) { t.colors[5] = 256; }), "");
    EXPECT_NE(faultOf([](TorusSource& t) { t.uv[5] = NAN; }), "");
    EXPECT_NE(faultOf([](TorusSource& t) { t.source.attributes[1].grid = 5; }), "");
}

TEST(AttributeName, IsUtf8WithoutControlCharacters)
{
    const auto isName = [](const std::string& text) {
        return isAttributeName({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    };
    EXPECT_TRUE(isName("color"));
    EXPECT_TRUE(isName("K\xC3\xBChle \xE6\xB8\xA9 \xF0\x9F\x8C\xA1"));
    EXPECT_TRUE(isName(std::string(63, 'x')));
    EXPECT_FALSE(isName(std::string(64, 'x')));
    EXPECT_FALSE(isName(""));
    EXPECT_FALSE(isName(std::string("a\0b", 3)));
    EXPECT_FALSE(isName("\x1B[2J"));
    EXPECT_FALSE(isName("\xC0\x80"));         // too long a form
    EXPECT_FALSE(isName("\xED\xA0\x80"));     // half a surrogate pair
    EXPECT_FALSE(isName("\xF4\x90\x80\x80")); // beyond the last character
    EXPECT_FALSE(isName("\xE6\xB8"));         // cut short
    EXPECT_FALSE(isName("\xC2\x85"));         // a control character
}

double meanAngle(const std::vector<float>& a, const std::vector<float>& b)
{
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); k += 3) {
        double squared = 0;
        for (std::size_t c = k; c < k + 3; ++c)
            squared += (double{a[c]} - double{b[c]}) * (double{a[c]} - double{b[c]});
        sum += 2 * std::asin(std::min(1.0, std::sqrt(squared) / 2));
    }
    return sum / (static_cast<double>(a.size()) / 3);
}

TEST(FieldNormals, AreNearerThanWaveletNormalsOfAsManyBytes)
{
    TorusSource torus;
    // A torus with waves: its normals take more than a few bytes.
    for (std::size_t k = 0; k < torus.normals.size(); k += 3) {
        const double x = static_cast<double>(k / 3 % 129) / 128, y = static_cast<double>(k / 387) / 128;
        torus.normals[k] += static_cast<float>(0.4 * std::sin(2 * std::numbers::pi * 9 * x));
        torus.normals[k + 1] += static_cast<float>(0.4 * std::cos(2 * std::numbers::pi * 7 * (x + y)));
    }
    normalize(torus.normals.data(), torus.normals.size() / 3);
    const std::vector<float> geometry = samples::bumpyImage(65, 5);
    torus.source.xyz = geometry;
    torus.source.normalGrid = 129;
    torus.source.normals = torus.normals;
    const Encoder encoder = prepared(torus.source);
    double error[2];
    for (const gim_coding coding : {GIM_CODING_SURFACE, GIM_CODING_WAVELET}) {
        auto made = encoder.encodeToBytes(6000, coding);
        ASSERT_TRUE(std::holds_alternative<EncodedFile>(made));
        const Bytes bytes = std::get<EncodedFile>(made).bytes;
        const std::vector<float> decoded = samples::decoded(bytes, 0, true);
        for (std::size_t k = 0; k < decoded.size(); k += 3)
            ASSERT_NEAR(decoded[k] * decoded[k] + decoded[k + 1] * decoded[k + 1] +
                            decoded[k + 2] * decoded[k + 2],
                        1, 1e-6);
        error[coding == GIM_CODING_WAVELET] = meanAngle(decoded, torus.normals);
    }
    EXPECT_LT(error[0], 0.95 * error[1]);
}

TEST(WithFields, LeavesTheGeometryAsItIs)
{
    TorusSource torus;
    torus.addAll();
    const EncodedFile before = fileOf(prepared(torus.source), 3600);
    for (float& value : torus.colors) value = 255 - value;
    auto set = FieldSet::prepare(torus.source);
    ASSERT_TRUE(std::holds_alternative<FieldSet>(set));
    auto made = withFields(before.bytes, std::get<FieldSet>(set), Settings{}, 3600);
    ASSERT_TRUE(std::holds_alternative<EncodedFile>(made));
    const Bytes after = std::get<EncodedFile>(made).bytes;
    EXPECT_LE(after.size(), 4000u);
    EXPECT_GE(after.size(), 3500u);
    EXPECT_EQ(samples::decoded(after), samples::decoded(before.bytes));
    EXPECT_LE(largestDifference(decodedAttribute<std::uint8_t>(after, 0), torus.colors), 4);
}

} // namespace
} // namespace gimg::codec

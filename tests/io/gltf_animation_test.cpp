#include "random.hpp"
#include "refusal.hpp"

#include <freiform/animate/keys.hpp>
#include <freiform/io/gltf_animation.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace freiform {
namespace {

using test::Random;
using AnimationJson = nlohmann::json;

std::string floats(const std::vector<double>& numbers) {
    std::string out;
    for (const double x : numbers) {
        const float f = float(x);
        out.append(reinterpret_cast<const char*>(&f), 4);
    }
    return out;
}
std::string base64(const std::string& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned v = 0;
        for (std::size_t k = 0; k < 3; ++k)
            v = v << 8 | (i + k < bytes.size() ? (unsigned char)bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k > bytes.size() ? '=' : kDigits[v >> (18 - 6 * k) & 63];
    }
    return out;
}

// One channel of one animation.
AnimationJson gltf(const std::string& path, const std::string& way, const std::vector<double>& times,
                   const std::vector<double>& values, std::size_t components) {
    const std::string bytes = floats(times) + floats(values);
    const char* type = components == 1 ? "SCALAR" : components == 3 ? "VEC3" : "VEC4";
    return {
        {"asset", {{"version", "2.0"}}},
        {"nodes", {{{"name", "n"}}}},
        {"buffers",
         {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteLength", 4 * times.size()}},
          {{"buffer", 0}, {"byteOffset", 4 * times.size()}, {"byteLength", 4 * values.size()}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"count", times.size()}, {"type", "SCALAR"}},
          {{"bufferView", 1},
           {"componentType", 5126},
           {"count", values.size() / components},
           {"type", type}}}},
        {"animations",
         {{{"name", "a"},
           {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}},
           {"samplers", {{{"input", 0}, {"output", 1}, {"interpolation", way}}}}}}}};
}
GltfChannel only(const AnimationJson& file) {
    const auto read = read_gltf_animations(file.dump());
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return read && read->size() == 1 && (*read)[0].channels.size() == 1 ? (*read)[0].channels[0]
                                                                        : GltfChannel{};
}
std::vector<double> random_floats(Random& random, std::size_t n) {
    std::vector<double> out(n);
    for (double& x : out) x = double(float(random.real(-1, 1)));
    return out;
}

// The formula of appendix C, for a value x at time t.
double cubic(double p, double out_tangent, double q, double in_tangent, double td, double t) {
    return (2 * t * t * t - 3 * t * t + 1) * p + td * (t * t * t - 2 * t * t + t) * out_tangent +
           (-2 * t * t * t + 3 * t * t) * q + td * (t * t * t - t * t) * in_tangent;
}

TEST(GltfAnimation, cubic_splines_are_the_formula_of_the_specification) {
    Random random(21);
    const std::vector<double> times = {0.5, 1, 2.25, 3};
    for (const auto& [path, n] : {std::pair{"translation", 3u}, {"scale", 3u}, {"rotation", 4u}}) {
        const auto values = random_floats(random, 12 * n);
        const GltfChannel c = only(gltf(path, "CUBICSPLINE", times, values, n));
        ASSERT_EQ(c.components, n);
        EXPECT_EQ(c.values, values);
        EXPECT_EQ(c.node, "n");
        std::vector<double> out(n);
        for (std::size_t i = 0; i + 1 < 4; ++i)
            for (double t = 0; t < 1; t += 0.0625) {
                const double td = times[i + 1] - times[i];
                evaluate(c, times[i] + t * td, out);
                std::vector<double> expected;
                const auto at = [&](std::size_t key, std::size_t part, std::size_t k) {
                    return values[(3 * key + part) * n + k];
                };
                for (std::size_t k = 0; k < n; ++k)
                    expected.push_back(
                        cubic(at(i, 1, k), at(i, 2, k), at(i + 1, 1, k), at(i + 1, 0, k), td, t));
                if (n == 4) {
                    double norm = 0;
                    for (const double x : expected) norm += x * x;
                    for (double& x : expected) x /= std::sqrt(norm);
                }
                for (std::size_t k = 0; k < n; ++k) EXPECT_NEAR(out[k], expected[k], 1e-14);
            }
    }
}

TEST(GltfAnimation, steps_lines_and_turns) {
    const GltfChannel line = only(gltf("translation", "LINEAR", {1, 3}, {0, 0, 0, 2, 4, -2}, 3));
    std::vector<double> out(3);
    evaluate(line, 2, out);
    EXPECT_EQ(out, (std::vector<double>{1, 2, -1}));
    evaluate(line, 0, out);
    EXPECT_EQ(out, (std::vector<double>{0, 0, 0}));
    evaluate(line, 9, out);
    EXPECT_EQ(out, (std::vector<double>{2, 4, -2}));
    const GltfChannel step = only(gltf("scale", "STEP", {1, 3}, {0, 0, 0, 2, 4, -2}, 3));
    evaluate(step, 2.99, out);
    EXPECT_EQ(out, (std::vector<double>{0, 0, 0}));
    const double r = std::sqrt(0.5);
    const GltfChannel turn = only(gltf("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, -r, -r}, 4));
    std::vector<double> q(4);
    evaluate(turn, 0.5, q);  // an eighth turn about z, the shorter way
    EXPECT_NEAR(std::abs(q[2]), std::sin(M_PI / 8), 1e-7);
    EXPECT_NEAR(q[3] / q[2], 1 / std::tan(M_PI / 8), 1e-6);
    const GltfChannel weights = only(gltf("weights", "LINEAR", {0, 2}, {0, 1, 4, 1}, 1));
    ASSERT_EQ(weights.components, 2u);
    evaluate(weights, 1, q = {0, 0});
    EXPECT_EQ(q, (std::vector<double>{2, 1}));
}

TEST(GltfAnimation, reads_normalised_integers_and_strides) {
    auto file = gltf("rotation", "STEP", {0}, {0, 0, 0, 1}, 4);
    const std::int16_t q[] = {0, 0, -32768, 32767};
    std::string bytes = floats({0});
    bytes += std::string(reinterpret_cast<const char*>(q), 8) + "....";
    file["buffers"][0] = {{"byteLength", bytes.size()}, {"uri", "data:;base64," + base64(bytes)}};
    file["bufferViews"][1] = {{"buffer", 0}, {"byteOffset", 4}, {"byteLength", 12}, {"byteStride", 12}};
    file["accessors"][1] = {
        {"bufferView", 1}, {"componentType", 5122}, {"normalized", true}, {"count", 1}, {"type", "VEC4"}};
    const GltfChannel c = only(file);
    EXPECT_EQ(c.values, (std::vector<double>{0, 0, -1, 1}));
}

TEST(GltfAnimation, what_is_written_is_read_back) {
    GltfMotion m;
    for (int i = 0; i <= 10; ++i) {
        m.times.push_back(i / 8.0);
        m.places.push_back({{double(i), double(i * i), -1}});
        m.velocities.push_back({{8, 16.0 * i, 0}});
        m.facing.push_back(turn_about({{0, 0, 1}}, i * 0.25));
        m.line.push_back(m.places.back());
    }
    const auto bytes = to_animated_glb(m);
    ASSERT_TRUE(bytes);
    const auto read = read_gltf_animations(*bytes);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ((*read)[0].channels.size(), 2u);
    const GltfChannel &place = (*read)[0].channels[0], &turn = (*read)[0].channels[1];
    EXPECT_EQ(place.interpolation, GltfInterpolation::cubic_spline);
    EXPECT_EQ(place.times, m.times);
    std::vector<double> out(3), q(4);
    for (double t = 0; t <= 1.25; t += 0.01) {  // the parabola is met between the keys, too
        evaluate(place, t, out);
        EXPECT_NEAR(out[0], 8 * t, 1e-12);
        EXPECT_NEAR(out[1], 64 * t * t, 1e-10);
        evaluate(turn, t, q);
        EXPECT_LE(angle_between(unit({q[0], q[1], q[2], q[3]}), turn_about({{0, 0, 1}}, 2 * t)), 1e-6);
    }
    m.places[3][0] = 1e60;
    test::expect_refusal(to_animated_glb(m), RefusalKind::limit, "");
    m.times.pop_back();
    test::expect_refusal(to_animated_glb(m), RefusalKind::invalid, "times");
}

TEST(GltfAnimation, refuses_what_contradicts_itself) {
    const auto good = gltf("translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 1, 1}, 3);
    const auto refused = [&](const char* pointer, AnimationJson value, const char* where,
                             RefusalKind kind = RefusalKind::unreadable) {
        auto bad = good;
        bad[AnimationJson::json_pointer(pointer)] = std::move(value);
        test::expect_refusal(read_gltf_animations(bad.dump()), kind, where);
    };
    const char* channel = "animations[0].channels[0]";
    const auto in = [&](const char* rest) { return std::string(channel) + rest; };
    refused("/asset/version", "1.0", "asset.version");
    refused("/accessors/1/count", 3, in(".accessors[1]").c_str());
    refused("/accessors/1/count", 4294967296.0, in(".accessors[1]").c_str());
    refused("/accessors/1/count", 9e15, in(".accessors[1]").c_str());
    refused("/accessors/1/count", -1, in(".accessors[1]").c_str());
    refused("/accessors/1/type", "MAT4", in(".accessors[1]").c_str());
    refused("/accessors/0/count", 1, in(".output").c_str());
    refused("/bufferViews/1/byteOffset", 1e15, in(".accessors[1]").c_str());
    refused("/bufferViews/1/byteStride", 252, in(".accessors[1]").c_str());
    refused("/accessors/1/sparse", AnimationJson::object(), in(".accessors[1]").c_str(),
            RefusalKind::unsupported);
    refused("/animations/0/samplers/0/input", 7, in(".accessors[7]").c_str());
    refused("/animations/0/samplers/0/interpolation", "MAGIC", in(".interpolation").c_str());
    refused("/animations/0/channels/0/sampler", 1, in(".sampler").c_str());
    refused("/animations/0/channels/0/target/node", 5, in(".target").c_str());
    refused("/animations/0/channels/0/target/path", "pointer", in(".target.path").c_str());
    refused("/buffers/0/uri", "data:;base64,????", in(".buffers[0]").c_str());
    for (const char* uri : {"other.bin", "/etc/passwd", "../x.bin", "http://x/y"})
        refused("/buffers/0/uri", uri, in(".buffers[0]").c_str(), RefusalKind::unsupported);
    auto back = gltf("translation", "LINEAR", {1, 1}, {0, 0, 0, 1, 1, 1}, 3);
    test::expect_refusal(read_gltf_animations(back.dump()), RefusalKind::unreadable, in(".input"));
    auto nan = gltf("translation", "LINEAR", {0, 1}, {0, 0, NAN, 1, 1, 1}, 3);
    test::expect_refusal(read_gltf_animations(nan.dump()), RefusalKind::nonfinite, in(".accessors[1][0]"));
    test::expect_refusal(read_gltf_animations("glTF"), RefusalKind::unreadable, "");
    test::expect_refusal(
        read_gltf_animations(std::string("glTF\2\0\0\0\xff\xff\xff\xff\xff\xff\xff\xffJSON", 20)),
        RefusalKind::unreadable, "byte 8");
    EXPECT_TRUE(read_gltf_animations(R"({"asset": {"version": "2.0"}})")->empty());
}

// Channels that all show the same large accessor are a bomb.
TEST(GltfAnimation, limits_what_channels_hold_together) {
    std::vector<double> times(60000), values(180000);
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = double(i);
    auto file = gltf("translation", "LINEAR", times, values, 3);
    const auto one = file["animations"][0]["channels"][0];
    for (int i = 0; i < 500; ++i) file["animations"][0]["channels"].push_back(one);
    const auto read = read_gltf_animations(file.dump());
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().kind, RefusalKind::limit);
}

TEST(GltfAnimation, damaged_files_are_read_or_refused) {
    GltfMotion m;
    for (int i = 0; i < 5; ++i)
        m.times.push_back(i), m.places.push_back({}), m.velocities.push_back({}), m.facing.push_back({});
    const std::string good = *to_animated_glb(m);
    Random random(99);
    int refused = 0;
    for (int round = 0; round < 3000; ++round) {
        std::string bad = good;
        for (int k = 0; k < 1 + round % 4; ++k)
            bad[std::size_t(random.real(0, double(bad.size())))] = char(int(random.real(0, 256)));
        if (round % 7 == 0) bad.resize(std::size_t(random.real(0, double(bad.size()))));
        const auto read = read_gltf_animations(bad);
        refused += !read;
        if (!read) continue;
        for (const GltfAnimation& a : *read)
            for (const GltfChannel& c : a.channels) {
                std::vector<double> out(c.components);
                evaluate(c, 1.5, out);
            }
    }
    EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace freiform

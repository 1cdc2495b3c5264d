#include "rhino_file.hpp"
#include "rhino_step.hpp"

#include <freiform/io/rhino_read.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace freiform {

namespace {

using namespace rhino;

constexpr std::size_t kMostImages = 1'000'000;  // of objects, in stretched blocks
constexpr int kMostBlocksInBlocks = 32;         // blocks in each other
// That a model takes, of each byte of the text that it is made of.
constexpr std::uint64_t kMemoryPerByte = 16;
constexpr double kUnsaidTolerance = 1e-6;  // where a file says none

class Reader3dm {
public:
    Reader3dm(File3dm file, const StepReadOptions& options)
        : f_(std::move(file)),
          options_(options),
          step_(f_.tolerance > 0 ? f_.tolerance : kUnsaidTolerance,
                std::size_t(options.memory_bytes / kMemoryPerByte)) {
        for (std::size_t i = 0; i < f_.objects.size(); ++i)
            if (!f_.objects[i].uuid.empty()) by_uuid_.emplace(f_.objects[i].uuid, i);
    }

    Result<Model> read() {
        std::vector<int> shapes, wires;
        for (std::size_t i = 0; i < f_.objects.size(); ++i) {
            if (f_.objects[i].is_part_of_block) continue;
            if (auto ok = add(i, 0, nullptr, shapes, wires); !ok) return std::unexpected(ok.error());
        }
        tell_left_out(shapes.empty() ? 0 : wires.size());
        const std::vector<int>& items = shapes.empty() ? wires : shapes;
        if (items.empty()) {
            if (refused_.empty() && step_.refused.empty())
                return refuse(
                    RefusalKind::no_answer, "file",
                    text("the file has ", f_.objects.size(), " objects, but no surfaces and no curves"));
            const Refusal& r = refused_.empty() ? step_.refused.front() : refused_.front();
            return refuse(r.kind, r.where, text("nothing of the file could be taken over: ", r.message));
        }
        auto model = read_step(step_.take(items, f_.layers), options_);
        if (!model) return std::unexpected(step_.told(model.error()));
        return told(std::move(*model));
    }

private:
    // With what of the name is short.
    std::string label(std::size_t i) const {
        constexpr std::size_t kLongest = 60;
        const std::string& name = f_.objects[i].name;
        if (name.empty()) return text("object ", i);
        std::size_t n = std::min(name.size(), kLongest);
        while (n < name.size() && n > 0 && (name[n] & 0xC0) == 0x80) --n;  // whole characters
        return text("object ", i, " \"", name.substr(0, n), n < name.size() ? "...\"" : "\"");
    }

    // `map`: where it is an image of what the file has, because no block can be it.
    Result<void> add(std::size_t i, int depth, const AffineMap* map, std::vector<int>& shapes,
                     std::vector<int>& wires) {
        FileObject& o = f_.objects[i];
        ++visits_;
        if (auto ok = check_length(i); !ok) return ok;
        step_.begin(label(i));
        if (o.why) return refused_.push_back(within(i, *o.why)), Result<void>{};
        const Kind kind = o.object.of.kind;
        const auto style = [&](int item) {
            if (o.layer >= 0) step_.put_on_layer(o.layer, item);
            if (o.colour) step_.colour(*o.colour, item);
        };
        if (kind == Kind::instance) return add_instance(i, depth, map, shapes, wires);
        if (kind == Kind::passed_over) return {};
        if (kind == Kind::left_out || kind == Kind::bare) {
            auto& [number, where] = left_out_[o.object.of.name];
            if (number++ == 0) where = kind == Kind::bare ? "file" : label(i);
            return {};
        }
        if (o.curve || is_curve(kind)) {
            auto c = o.curve ? Result<CurveInSpace>(*o.curve) : read_curve(o.object);
            if (c && map != nullptr) c = mapped(*c, *map);
            const auto id = c ? step_.curve(*c, o.name) : Result<int>(std::unexpected(c.error()));
            if (!id) return refused_.push_back(within(i, id.error())), Result<void>{};
            style(*id);
            wires.push_back(*id);
            return {};
        }
        auto b = o.brep ? Result<BrepOf>(*o.brep) : brep_of(o.object);
        if (b && map != nullptr) b = mapped(*b, *map);
        const auto ids = b ? step_.brep(*b, o.name) : Result<std::vector<int>>(std::unexpected(b.error()));
        if (!ids) return refused_.push_back(within(i, ids.error())), Result<void>{};
        for (const int id : *ids) style(id), shapes.push_back(id);
        return check_length(i);
    }

    Result<void> check_length(std::size_t i) const {
        if (visits_ > f_.objects.size() + kMostImages)
            return refuse(RefusalKind::limit, label(i),
                          text("stretched blocks have more than ", kMostImages, " objects in all"));
        if (!step_.is_too_long()) return {};
        return refuse(RefusalKind::limit, label(i),
                      text("the model takes more than the ", options_.memory_bytes, " bytes that it may"));
    }

    static bool is_curve(Kind k) {
        return k == Kind::nurbs_curve || k == Kind::line_curve || k == Kind::arc_curve ||
               k == Kind::polyline_curve || k == Kind::poly_curve;
    }

    static Result<BrepOf> brep_of(const StoredObject& o) {
        if (o.of.kind == Kind::brep) return read_brep(o);
        if (o.of.kind == Kind::extrusion) return read_extrusion(o);
        auto s = read_surface(o);
        if (!s) return std::unexpected(s.error());
        return whole_face(std::move(*s));
    }

    Result<void> add_instance(std::size_t i, int depth, const AffineMap* outer, std::vector<int>& shapes,
                              std::vector<int>& wires) {
        Bytes b = f_.objects[i].object.data;
        int minor = 0;
        b.version(minor);
        const std::string of = b.uuid();
        std::array<double, 16> m{};
        for (double& x : m) x = b.f64();
        const auto refused = [&](RefusalKind kind, std::string why) {
            refused_.push_back({kind, label(i), std::move(why)});
            return Result<void>{};
        };
        if (b.failed()) return refused(RefusalKind::unreadable, "an instance ends too early");
        if (auto ok = b.check_sum(); !ok) return refused(ok.error().kind, ok.error().message);
        if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
            return refused(RefusalKind::unsupported, "an instance of a block that is projected");
        AffineMap map{{{m[3], m[7], m[11]}}, {}};
        for (std::size_t k = 0; k < 3; ++k) map.axes[k] = {{m[k], m[k + 4], m[k + 8]}};
        if (outer != nullptr) map = *outer * map;
        const auto block = block_of(of, depth + 1);
        if (!block) {
            if (block.error().kind == RefusalKind::limit) return std::unexpected(block.error());
            return refused(block.error().kind, block.error().message);
        }
        step_.begin(label(i));
        const std::string& name = f_.objects[i].name;
        for (std::size_t k = 0; k < 2; ++k) {
            if ((*block)[k] == 0) continue;
            const auto id = step_.instance((*block)[k], name.empty() ? f_.blocks.at(of).name : name, map);
            if (!id) return add_members(of, depth + 1, map, shapes, wires);
            if (f_.objects[i].layer >= 0) step_.put_on_layer(f_.objects[i].layer, *id);
            (k == 0 ? shapes : wires).push_back(*id);
        }
        return {};
    }

    // Of a block whose image is no similar one: each by itself.
    Result<void> add_members(const std::string& block, int depth, const AffineMap& map,
                             std::vector<int>& shapes, std::vector<int>& wires) {
        for (const std::string& member : f_.blocks.at(block).members)
            if (const auto object = by_uuid_.find(member); object != by_uuid_.end())
                if (auto ok = add(object->second, depth, &map, shapes, wires); !ok) return ok;
        return {};
    }

    // Its faces and its curves, each as a representation; 0 where it has none.
    Result<std::array<int, 2>> block_of(const std::string& uuid, int depth) {
        if (const auto known = made_.find(uuid); known != made_.end()) return known->second;
        const auto at = f_.blocks.find(uuid);
        if (at == f_.blocks.end())
            return refuse(RefusalKind::invalid, "", "an instance of a block that the file does not have");
        if (!open_.insert(uuid).second)
            return refuse(RefusalKind::invalid, "",
                          text("the block \"", at->second.name, "\" contains itself"));
        if (depth > kMostBlocksInBlocks) return refuse(RefusalKind::limit, "", "blocks are nested too deep");
        std::vector<int> shapes, wires;
        for (const std::string& member : at->second.members) {
            const auto object = by_uuid_.find(member);
            if (object == by_uuid_.end()) continue;
            if (auto ok = add(object->second, depth, nullptr, shapes, wires); !ok)
                return std::unexpected(ok.error());
        }
        open_.erase(uuid);
        if (shapes.empty() && wires.empty() && at->second.members.empty())
            return refuse(RefusalKind::unsupported, "",
                          text("an instance of the block \"", at->second.name,
                               "\", which is empty or in another file"));
        const std::array<int, 2> made{shapes.empty() ? 0 : step_.block(at->second.name, shapes),
                                      wires.empty() ? 0 : step_.block(at->second.name, wires)};
        made_.emplace(uuid, made);
        return made;
    }

    Refusal within(std::size_t i, Refusal r) const {
        r.where = r.where.empty() ? label(i) : text(label(i), ", ", r.where);
        return r;
    }

    void tell_left_out(std::size_t curves) {
        const auto tell = [&](std::string where, std::string message) {
            refused_.push_back({RefusalKind::unsupported, std::move(where), std::move(message)});
        };
        if (curves > 0)
            tell("file", text(curves, curves == 1 ? " curve that bounds no face is left out"
                                                  : " curves that bound no face are left out"));
        for (const auto& [what, of] : left_out_)
            tell(of.second,
                 text(what, ": ", of.first, of.first == 1 ? " object is left out" : " objects are left out"));
    }

    Model told(Model m) {
        m.unit = f_.unit;
        for (Refusal& r : m.refused) r = step_.told(std::move(r));
        for (Approximation& a : m.approximations)
            a.where = step_.told(a.where, true), a.what = step_.told(a.what, true);
        for (Repair& r : m.repairs) r.where = step_.told(r.where, true), r.what = step_.told(r.what, false);
        for (auto* more : {&step_.refused, &refused_})
            m.refused.insert(m.refused.end(), more->begin(), more->end());
        return m;
    }

    File3dm f_;
    StepReadOptions options_;
    StepText step_;
    std::map<std::string, std::size_t> by_uuid_;
    std::map<std::string, std::array<int, 2>> made_;
    std::set<std::string> open_;
    std::size_t visits_ = 0;  // of objects, also as parts of stretched blocks
    std::map<std::string_view, std::pair<std::size_t, std::string>> left_out_;  // where: of the first
    std::vector<Refusal> refused_;
};

}  // namespace

Result<Model> read_3dm(std::string_view bytes, const StepReadOptions& options) {
    auto file = parse_3dm(bytes);
    if (!file) return std::unexpected(file.error());
    return Reader3dm(std::move(*file), options).read();
}

}  // namespace freiform

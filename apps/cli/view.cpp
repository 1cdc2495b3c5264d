// view: the page of the studio on a file, served to the browser of this machine. bindings/wasm/VIEW.md says
// what the page finds where.
#include "http_server.hpp"
#include "input.hpp"
#include "page.hpp"
#include "tessellate_report.hpp"
#include "words.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/mesh_file.hpp>
#include <freiform/io/scene.hpp>

#include <cmath>
#include <fcntl.h>
#include <mutex>
#include <spawn.h>
#include <unistd.h>

extern char** environ;

namespace freiform::cli {

namespace {

struct ViewArguments {
    std::string file, page;
    std::optional<int> port;
    bool no_browser = false;
};

constexpr const char* kPolicy =
    "Content-Security-Policy: default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' "
    "'unsafe-inline'; img-src 'self' data: blob:; font-src 'self'; connect-src 'self' blob: data:; "
    "worker-src 'self' "
    "blob:; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

int status_of(RefusalKind kind) {
    switch (kind) {
        case RefusalKind::invalid:
        case RefusalKind::nonfinite:
        case RefusalKind::out_of_domain:
            return 400;
        case RefusalKind::limit:
        case RefusalKind::unavailable:
            return 503;
        case RefusalKind::io:
            return 500;
        default:
            return 422;
    }
}

HttpReply refused(const Refusal& r, int status) {
    json::Writer w;
    w.begin_object().key("error").begin_object().field("kind", name_of(r.kind));
    w.field("message", r.message).field("where", r.where).end_object().end_object();
    return {status, "application/json", w.take() + "\n"};
}

HttpReply as_json(json::Writer& w) { return {200, "application/json", w.take() + "\n"}; }

// The file as the page asks for it. Immutable but for the meshes that were made, which are kept.
class Viewed {
public:
    Viewed(Input input, std::uint64_t max_triangles)
        : input_(std::move(input)),
          max_triangles_((long long)(max_triangles)),
          scene_(scene_of(*input_.document)) {}

    HttpReply view() const {
        const Document& d = *input_.document;
        json::Writer w;
        w.begin_object().field("version", FREIFORM_VERSION);
        w.field("file", input_.file.substr(input_.file.rfind('/') + 1));
        const auto format = format_of_name(input_.file);
        w.field("format", format ? name_of(*format) : "").field("unit", d.unit).key("objects").begin_array();
        std::size_t models = 0;
        for (const Object& o : d.objects) {
            w.begin_object().field("name", o.name).field("type", type_name(o.shape)).end_object();
            models += std::holds_alternative<Model>(o.shape);
        }
        w.end_array().field("models", models).key("box");
        Box<3> box = scene_ ? summary(*scene_).box : Box<3>{};
        for (const Object& o : d.objects) {
            const ControlBox control = control_box(o.shape);
            for (const auto* corner : {&control.lo, &control.hi}) {
                Vec<3> x{};
                for (std::size_t k = 0; k < std::min<std::size_t>(3, corner->size()); ++k)
                    x[int(k)] = (*corner)[k];
                if (!corner->empty()) box.add(x);
            }
        }
        if (box.is_empty())
            w.null();
        else
            w.begin_object().key("min").array(box.lo.c).key("max").array(box.hi.c).end_object();
        w.end_object();
        return as_json(w);
    }

    HttpReply document() const { return {200, "application/json", write_document(*input_.document)}; }

    HttpReply faces() const {
        json::Writer w;
        w.begin_object().key("faces").begin_array();
        for (std::size_t i = 0; i < input_.document->objects.size(); ++i)
            if (const auto* model = std::get_if<Model>(&input_.object(i).shape)) write_faces(w, i, *model);
        w.end_array().key("refused").begin_array();
        for (const Refusal& r : input_.document->left_out) write_refusal(w, r);
        for (const Object& o : input_.document->objects)
            if (const auto* model = std::get_if<Model>(&o.shape))
                for (const Refusal& r : model->refused) write_refusal(w, r);
        w.end_array().key("approximations").begin_array();
        for (const Object& o : input_.document->objects) {
            for (const Approximation& a : o.approximations) write_approximation(w, a);
            if (const auto* model = std::get_if<Model>(&o.shape))
                for (const Approximation& a : model->approximations) write_approximation(w, a);
        }
        w.end_array();
        std::vector<Repair> repairs;
        for (const Object& o : input_.document->objects)
            if (const auto* model = std::get_if<Model>(&o.shape))
                repairs.insert(repairs.end(), model->repairs.begin(), model->repairs.end());
        write_repairs(w, repairs);
        w.end_object();
        return as_json(w);
    }

    HttpReply glb(std::string_view query) {
        return with_mesh(query, [](const Made& m, const Model&) -> HttpReply {
            auto bytes = to_glb(m.tessellation.mesh);
            if (!bytes) return refused(bytes.error(), status_of(bytes.error().kind));
            return {200, "model/gltf-binary", *std::move(bytes)};
        });
    }
    HttpReply report(std::string_view query) {
        return with_mesh(query, [](const Made& m, const Model& model) {
            json::Writer w;
            const std::optional<Sewing> none;
            write_report(
                w, {m.tessellation, model, none, m.how, "", 0, {0, 0, 0, m.tessellation.seconds.total}, {}});
            return as_json(w);
        });
    }

private:
    struct Made {
        TessellateOptions how;
        Tessellation tessellation;
    };
    static constexpr std::size_t kKept = 3;  // meshes

    static void write_faces(json::Writer& w, std::size_t object, const Model& model) {
        for (std::size_t f = 0; f < model.faces.size(); ++f) {
            const Face& face = model.faces[f];
            w.new_line(1).begin_object().field("object", object).field("face", f).field("name", face.name);
            w.field("loops", face.loops.size()).key("colour");
            if (face.colour)
                w.begin_array()
                    .value(double(face.colour->r))
                    .value(double(face.colour->g))
                    .value(double(face.colour->b))
                    .end_array();
            else
                w.null();
            w.end_object();
        }
    }
    static void write_refusal(json::Writer& w, const Refusal& r) {
        w.new_line(1).begin_object().field("where", r.where).field("kind", name_of(r.kind));
        w.field("message", r.message).end_object();
    }

    // One mesh is made at a time; a tolerance that is asked for twice is meshed once.
    HttpReply with_mesh(std::string_view query,
                        const std::function<HttpReply(const Made&, const Model&)>& answer) {
        if (!scene_) return refused(scene_.error(), status_of(scene_.error().kind));
        const std::string_view given = query_field(query, "tolerance");
        const auto tolerance = given.empty() ? std::optional(summary(*scene_).box.diagonal() / 1000)
                                             : scan_number<double>(given);
        if (!tolerance || !(*tolerance > 0) || !std::isfinite(*tolerance))
            return refused({RefusalKind::invalid, "tolerance", "a positive number was expected"}, 400);
        const std::lock_guard lock(making_);
        for (const auto& m : made_)
            if (m->how.tolerance == *tolerance) return answer(*m, *scene_);
        TessellateOptions how;
        how.tolerance = *tolerance;
        how.max_triangles = max_triangles_;
        auto t = tessellate(*scene_, how);
        if (!t) return refused(t.error(), status_of(t.error().kind));
        if (made_.size() == kKept) made_.erase(made_.begin());
        made_.push_back(std::make_unique<Made>(how, *std::move(t)));
        return answer(*made_.back(), *scene_);
    }

    Input input_;
    long long max_triangles_;
    Result<Model> scene_;
    std::mutex making_;
    std::vector<std::unique_ptr<Made>> made_;
};

HttpReply route(Viewed& viewed, const Page& page, const HttpRequest& request) {
    if (request.path == "/view.json") return viewed.view();
    if (request.path == "/document.json") return viewed.document();
    if (request.path == "/faces.json") return viewed.faces();
    if (request.path == "/model.glb") return viewed.glb(request.query);
    if (request.path == "/report.json") return viewed.report(request.query);
    auto file = page.file(request.path);
    if (!file) return refused(file.error(), file.error().kind == RefusalKind::no_answer ? 404 : 500);
    return {200, std::move(file->type), std::move(file->bytes)};
}

// The browser goes on when this program has ended.
void open_browser(const std::string& address) {
    std::string program = "xdg-open", argument = address;
    char* arguments[] = {program.data(), argument.data(), nullptr};
    posix_spawn_file_actions_t quiet;
    ::posix_spawn_file_actions_init(&quiet);
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        ::posix_spawn_file_actions_addopen(&quiet, fd, "/dev/null", O_RDWR, 0);
    pid_t child = 0;
    if (::posix_spawnp(&child, program.c_str(), &quiet, nullptr, arguments, environ) != 0)
        remark(text("there is no xdg-open here: open ", address, " in a browser"));
    ::posix_spawn_file_actions_destroy(&quiet);
}

Result<void> run_view(const Context& context, const ViewArguments& options) {
    auto page = Page::open(options.page);
    if (!page) return std::unexpected(page.error());
    auto input = read_input(context, options.file, "");
    if (!input) return std::unexpected(input.error());
    Viewed viewed(*std::move(input), context.limits.max_triangles);
    auto server = HttpServer::listen(options.port.value_or(0));
    if (!server) return std::unexpected(server.error());
    for (const char* line :
         {kPolicy, "X-Content-Type-Options: nosniff", "Referrer-Policy: no-referrer",
          "Cross-Origin-Opener-Policy: same-origin", "Cross-Origin-Embedder-Policy: require-corp",
          "Cross-Origin-Resource-Policy: same-origin", "Cache-Control: no-cache"})
        server->add_header(line);
    const std::string address = text("http://127.0.0.1:", server->port(), "/");
    json::Writer w;
    w.begin_object().field("address", address).end_object();
    if (auto ok = emit({}, context.json ? w.take() + "\n" : address + "\n"); !ok) return ok;
    if (!options.no_browser) open_browser(address);
    server->serve([&](const HttpRequest& request) { return route(viewed, *page, request); });
}

}  // namespace

void add_view(CommandLine& line) {
    const auto options = std::make_shared<ViewArguments>();
    const Command command = line.add("view", "The studio on a file, in the browser of this machine",
                                     "  freiform view part.step\n"
                                     "  freiform view curves.json --no-browser --port 8080\n"
                                     "The address is printed; Ctrl+C ends it. Nothing leaves the machine.");
    command.file(options->file);
    command.count("--port", options->port, 0, 65535, "Where to listen on 127.0.0.1 (default 0: a free one)");
    command.flag("--no-browser", options->no_browser, "Only print the address");
    command.word("--page", options->page, "A folder with the page, instead of the one in the program")
        .shown_as("FOLDER");
    command.triangle_limit();
    command.action(options, run_view);
}

}  // namespace freiform::cli

// freiform-occt-import INPUT OUTPUT [--format step|iges|brep] [--verify]
//
// Reads INPUT with Open CASCADE and writes it to OUTPUT in the form of io/model_binary.hpp; OUTPUT "-" is
// standard output. A process of its own, because the reader may crash, hang or eat the memory on a damaged
// file: whoever calls it sets the limits. What it has to say is one line on standard error,
//     refusal TAB kind TAB where TAB message
// with exit status 3; status 0 means that OUTPUT is whole. STEP files are read by freiform-occt-import-step.
#include "convert.hpp"
#include "verify.hpp"

#include <freiform/core/heap.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/model_binary.hpp>
#include <freiform/model/rescale.hpp>

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <exception>
#include <fstream>
#include <iostream>
#include <malloc.h>
#include <new>
#include <sys/resource.h>
#include <unistd.h>

// Open CASCADE keeps what it allocated once; looking for leaks would only find those. Called by
// LeakSanitizer, unused in ordinary builds.
extern "C" int __lsan_is_turned_off();
extern "C" int __lsan_is_turned_off() { return 1; }

namespace {

using namespace freiform;

int say(const Refusal& r) {
    const auto line = [](std::string s) {
        for (char& c : s)
            if (c == '\t' || c == '\n' || c == '\r') c = ' ';
        return s;
    };
    std::cerr << "refusal\t" << name_of(r.kind) << '\t' << line(r.where) << '\t' << line(r.message)
              << std::endl;
    return 3;
}

struct Arguments {
    std::string input, output;
    occt::Format format = occt::Format::step;
    bool verify = false;
};

std::optional<Arguments> parse(int count, char** values) {
    Arguments a;
    std::vector<std::string> plain;
    bool given = false;
    for (int i = 1; i < count; ++i) {
        const std::string_view v = values[i];
        if (v == "--verify") {
            a.verify = true;
        } else if (v == "--format" && i + 1 < count) {
            const std::string_view name = values[++i];
            if (name != "step" && name != "iges" && name != "brep") return std::nullopt;
            a.format = name == "step"   ? occt::Format::step
                       : name == "iges" ? occt::Format::iges
                                        : occt::Format::brep;
            given = true;
        } else {
            plain.emplace_back(v);
        }
    }
    if (plain.size() != 2) return std::nullopt;
    a.input = plain[0], a.output = plain[1];
    if (!given) {
        std::string ending = a.input.substr(std::min(a.input.size(), a.input.rfind('.') + 1));
        for (char& c : ending) c = char(c >= 'A' && c <= 'Z' ? c + 32 : c);
        if (ending == "igs" || ending == "iges") a.format = occt::Format::iges;
        if (ending == "brep" || ending == "brp" || ending == "rle") a.format = occt::Format::brep;
    }
    return a;
}

Result<void> write_all(int fd, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return refuse(RefusalKind::io, "standard output", std::strerror(errno));
        bytes.remove_prefix(std::size_t(n));
    }
    return {};
}

// Threads take addresses before they use memory: few of them, and none where addresses are few.
void limit_threads() {
    constexpr rlim_t kEnough = rlim_t(2) << 30;
    struct rlimit limit {};
    const bool is_free = ::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY;
    set_max_threads(is_free || limit.rlim_cur >= kEnough ? 4 : 1);
#if defined(__GLIBC__)
    ::mallopt(M_ARENA_MAX, 2);
#endif
}

#ifndef FREIFORM_OCCT_STEP
// What reads STEP is beside this program, as its libraries take long to load. Comes back if it is not there.
int give_to_step_reader(char** values) {
    std::string path(4096, '\0');
    const ssize_t length = ::readlink("/proc/self/exe", path.data(), path.size());
    path.resize(std::size_t(std::max<ssize_t>(length, 0)));
    path += "-step";
    ::execv(path.c_str(), values);
    return say({RefusalKind::unavailable, path, std::strerror(errno)});
}
#endif

// Whether the address space was nearly used up at some time. The reader takes the failure of an allocation
// for a fault of the file.
bool ran_out_of_memory() {
    struct rlimit limit {};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return false;
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmPeak:")) {
            const std::size_t digits = std::min(line.find_first_of("0123456789"), line.size());
            unsigned long long kibibytes = 0;
            std::from_chars(line.data() + digits, line.data() + line.size(), kibibytes);
            return kibibytes * 1024 > limit.rlim_cur / 10 * 8;
        }
    return false;
}

// What becomes of a file, and how well it went.
struct Reading {
    occt::Document document;
    occt::Conversion conversion;
    double size = 0;   // the longest side of the box of its vertices
    double worst = 0;  // the largest tolerance of an edge, of that size
};

Result<Reading> read(const Arguments& a, occt::IgesWay way) {
    auto document = occt::read_document(a.input, a.format, way);
    if (!document) return std::unexpected(document.error());
    Reading out{*std::move(document), {}};
    out.conversion = occt::convert(out.document);
    Box<3> box;
    for (const Vertex& v : out.conversion.model.vertices) box.add(v.point);
    for (int d = 0; d < 3 && !box.is_empty(); ++d) out.size = std::max(out.size, box.side(d).length());
    for (const Edge& e : out.conversion.model.edges) out.worst = std::max(out.worst, e.tolerance / out.size);
    return out;
}

// An IGES file is read in other ways, too, where that may be better: where the reader's tolerances are not
// small against the numbers of the file, where it leaves out a face, a pole has two edges, or an edge is far
// off. Where faces are missing whatever the unit, it is asked to go by one kind of boundary curves alone.
Result<Reading> read(const Arguments& a) {
    constexpr double kSmall = 8, kFarOff = 1e-4, kWorst = 1e-3;
    auto best = read(a, occt::IgesWay{});
    if (!best || a.format != occt::Format::iges) return best;
    const auto attempt = [&](occt::IgesWay way) -> Result<Reading> {
        try {
            return read(a, way);
        } catch (const Standard_Failure& f) {  // what is read already is not lost for it
            return refuse(RefusalKind::unreadable, a.input, f.GetMessageString());
        }
    };
    const auto lost = [](const Reading& r) {  // but for what is said of the file as a whole
        return std::ranges::count_if(r.conversion.model.refused,
                                     [](const Refusal& x) { return x.where != "file"; });
    };
    const auto faults = [&](const Reading& r) { return std::pair(lost(r), r.conversion.doubts); };
    occt::IgesWay way;
    if (best->document.millimetres != 1) {
        const bool is_small = best->document.millimetres > 1 && best->size < kSmall;
        if (is_small || faults(*best) > std::pair(std::ptrdiff_t(0), 0) || best->worst > kFarOff)
            if (auto other = attempt({occt::Lengths::in_millimetres})) {
                const auto mine = faults(*best), others = faults(*other);
                if (others != mine ? others < mine : is_small || other->worst < best->worst) {
                    best = std::move(other);
                    way.lengths = occt::Lengths::in_millimetres;
                }
            }
    }
    const std::size_t faces = best->conversion.model.faces.size();
    for (const auto curves : {occt::Curves::in_parameters, occt::Curves::in_space}) {
        if (lost(*best) == 0) break;
        way.curves = curves;
        auto other = attempt(way);
        if (other && other->conversion.model.faces.size() >= faces && faults(*other) < faults(*best) &&
            other->worst <= std::max(best->worst, kWorst)) {
            best = std::move(other);
            best->conversion.model.approximations.push_back(
                {"file",
                 text("faces are missing by the boundary curves that it prefers; those in ",
                      curves == occt::Curves::in_space ? "space" : "the parameters", " are taken"),
                 0.0, 0});
        }
    }
    return best;
}

int run(const Arguments& a, int output) {
    auto reading = read(a);
    if (!reading && ran_out_of_memory())
        return say({RefusalKind::limit, a.input, "the memory limit is too small for this file"});
    if (!reading) return say(reading.error());
    occt::Conversion& c = reading->conversion;
    if (c.model.faces.empty() && c.model.edges.empty()) {
        if (c.model.refused.empty())
            return say({RefusalKind::no_answer, a.input, "the file has no faces and no curves"});
        return say({c.model.refused.back().kind, c.model.refused.back().where,
                    text("nothing of the file could be taken over: ", c.model.refused.back().message)});
    }
    if (a.verify && !occt::verify(c, a.input)) return 1;
    auto model = make_model(std::move(c.model));
    if (!model) return say({RefusalKind::unreadable, model.error().where, model.error().message});
    if (const double factor = reading->document.factor; factor != 1) model = divided(*model, factor);
    if (!model) return say(model.error());
    const std::string bytes = to_binary(*model);
    if (a.output == "-") {
        if (auto ok = write_all(output, bytes); !ok) return say(ok.error());
    } else if (auto ok = write_file(a.output, bytes); !ok) {
        return say(ok.error());
    }
    return 0;
}

}  // namespace

int main(int count, char** values) {
    const auto arguments = parse(count, values);
    if (!arguments) {
        std::cerr << "usage: freiform-occt-import INPUT OUTPUT [--format step|iges|brep] [--verify]\n";
        return 2;
    }
#ifndef FREIFORM_OCCT_STEP
    if (arguments->format == occt::Format::step) return give_to_step_reader(values);
#endif
    // The reader prints to standard output now and then; only the model may go there.
    const int output = ::dup(STDOUT_FILENO);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
    limit_threads();
    use_large_pages();
    try {
        return run(*arguments, output);
    } catch (const Standard_OutOfMemory&) {
        return say({RefusalKind::limit, arguments->input, "the memory limit is too small for this file"});
    } catch (const std::bad_alloc&) {
        return say({RefusalKind::limit, arguments->input, "the memory limit is too small for this file"});
    } catch (const Standard_Failure& f) {
        return say({RefusalKind::unreadable, arguments->input,
                    text("the reader gave up: ", f.DynamicType()->Name(), " ", f.GetMessageString())});
    } catch (const std::exception& e) {
        return say({RefusalKind::unreadable, arguments->input, text("the reader gave up: ", e.what())});
    }
}

// The options of the commands where CLI11 cannot be: it throws, and this is compiled without exceptions.
//
// Arguments mean the same as there: `--name value`, `--name=value`, `-o value`; what begins with a dash and a
// letter is an option, so that -1 is a number; what is no option fills the arguments without a name in their
// order.
#include "module.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/core/spelling.hpp>

#include <algorithm>
#include <command.hpp>

namespace CLI {

// Takes so many words, each of which `use` understands.
class Option {
public:
    std::vector<std::string> names;  // "--output", "-o"; one without dashes for an argument
    std::string help, shown_as = "TEXT";
    std::vector<std::string> words;  // the only ones that are allowed, if any
    std::size_t least = 1, most = 1;
    bool is_required = false, given = false;
    std::function<void(const std::string&)> use;

    bool is_called(std::string_view name) const { return std::ranges::find(names, name) != names.end(); }
    bool is_argument() const { return !names[0].starts_with('-'); }
    const std::string& name() const {  // the long one
        return *std::ranges::max_element(names, {}, &std::string::size);
    }
};

class App {
public:
    std::string name, description, footer;
    std::vector<std::unique_ptr<Option>> options;
    std::vector<std::unique_ptr<App>> commands;
    std::function<void()> act;

    Option& add(std::string_view names, std::string_view help, std::function<void(const std::string&)> use) {
        options.push_back(std::make_unique<Option>());
        Option& o = *options.back();
        while (!names.empty()) o.names.emplace_back(freiform::next_part(names, ','));
        o.help = help, o.use = std::move(use);
        return o;
    }
    Option* find(std::string_view called) const {
        for (const auto& o : options)
            if (o->is_called(called)) return o.get();
        return nullptr;
    }
};

}  // namespace CLI

namespace freiform::cli {

namespace {

bool is_option(std::string_view word) {
    if (word.size() < 2 || word[0] != '-') return false;
    const char c = word[word[1] == '-' && word.size() > 2 ? 2 : 1];
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

template <class T>
auto positive_number(const std::string& name, T& value) {
    return [name, &value](const std::string& s) {
        const auto x = scan_number<double>(s);
        if (!x || !(*x > 0)) wrong_usage(text(name, " needs a positive number, found \"", s, "\""));
        value = T(*x);
    };
}

std::optional<std::string> refusal_of_word(const CLI::Option& o, const std::string& word) {
    if (o.words.empty() || std::ranges::find(o.words, word) != o.words.end()) return std::nullopt;
    const std::vector<std::string_view> known(o.words.begin(), o.words.end());
    return text(o.name(), ": ", word, " not in {", listed(known), "}");
}

std::string help_of(const CLI::App& program) {
    std::string s = text(program.description, "\n\nCommands:\n");
    for (const auto& c : program.commands)
        s += text("  ", c->name, std::string(14 - std::min<std::size_t>(13, c->name.size()), ' '),
                  c->description, "\n");
    return text(s, "\n", program.footer, "\n");
}

std::string help_of_command(const CLI::App& c) {
    std::string s = text(c.description, "\nUsage: freiform ", c.name, " [OPTIONS]");
    for (const auto& o : c.options)
        if (o->is_argument()) s += text(" ", o->name());
    s += "\n\n";
    for (const auto& o : c.options) {
        std::string left =
            text("  ", o->name(), o->is_argument() ? "" : " ", o->is_argument() ? "" : o->shown_as);
        left.resize(std::max<std::size_t>(30, left.size() + 1), ' ');
        s += text(left, o->help, o->is_required ? " (required)" : "", "\n");
    }
    return text(s, "\nExamples:\n", c.footer, "\n");
}

// Understands the arguments of one command.
struct Reader {
    const CLI::App& command;
    std::span<const std::string> rest;
    std::string help = text(" (freiform ", command.name, " --help)");

    std::optional<std::string> read() {
        bool only_arguments = false;
        while (!rest.empty()) {
            const std::string word = rest[0];
            if (!only_arguments && word == "--") {
                only_arguments = true, rest = rest.subspan(1);
            } else if (!only_arguments && is_option(word)) {
                if (auto wrong = option(word)) return wrong;
            } else if (auto wrong = argument()) {
                return wrong;
            }
        }
        for (const auto& o : command.options)
            if (o->is_required && !o->given) return text(o->name(), " is required", help);
        return std::nullopt;
    }

private:
    std::optional<std::string> take(CLI::Option& o, const std::string& word) {
        if (auto wrong = refusal_of_word(o, word)) return text(*wrong, help);
        o.given = true;
        o.use(word);
        return std::nullopt;
    }

    std::optional<std::string> option(const std::string& word) {
        const std::size_t equals = word.find('=');
        const std::string name = word.substr(0, equals);
        CLI::Option* o = command.find(name);
        if (!o) {
            std::vector<std::string_view> known;
            for (const auto& other : command.options)
                if (!other->is_argument()) known.push_back(other->name());
            return text("there is no option ", name, did_you_mean(name, known), help);
        }
        rest = rest.subspan(1);
        if (o->given && o->most == 1) return text(name, " is given twice", help);
        std::size_t taken = 0;
        if (equals != std::string::npos) {
            if (auto wrong = take(*o, word.substr(equals + 1))) return wrong;
            ++taken;
        }
        for (; taken < o->most && equals == std::string::npos && !rest.empty() && !is_option(rest[0]);
             ++taken) {
            const std::string value = rest[0];
            rest = rest.subspan(1);
            if (auto wrong = take(*o, value)) return wrong;
        }
        if (taken < o->least) return text(name, " needs a value", help);
        if (taken == 0) o->given = true, o->use("");
        return std::nullopt;
    }

    std::optional<std::string> argument() {
        for (const auto& o : command.options) {
            if (!o->is_argument() || (o->given && o->most == 1)) continue;
            const std::string word = rest[0];
            rest = rest.subspan(1);
            return take(*o, word);
        }
        return text("\"", rest[0], "\" was not expected", help);
    }
};

}  // namespace

// One option
// -------------------------------------------------------------------------------------------------

Option Option::required() const {
    option_->is_required = true;
    return *this;
}
Option Option::shown_as(std::string_view value) const {
    option_->shown_as = value;
    return *this;
}
Option Option::one_of(std::initializer_list<std::string_view> words) const {
    option_->words.assign(words.begin(), words.end());
    return *this;
}

// Options of a command
// ---------------------------------------------------------------------------------------

Option Command::use(std::string_view name, Use&& use, std::string_view help,
                    std::string_view shown_as) const {
    return Option(app_->add(name, help, std::move(use))).shown_as(shown_as);
}

Option Command::flag(std::string_view name, bool& value, std::string_view help) const {
    CLI::Option& o = app_->add(name, help, [&value](const std::string&) { value = true; });
    o.least = o.most = 0;
    return Option(o).shown_as("");
}
Option Command::word(std::string_view name, std::string& value, std::string_view help) const {
    return use(
        name, [&value](const std::string& s) { value = s; }, help, "TEXT");
}
Option Command::words(std::string_view name, std::vector<std::string>& values, std::string_view help) const {
    CLI::Option& o = app_->add(name, help, [&values](const std::string& s) { values.push_back(s); });
    o.most = std::size_t(-1);
    return Option(o);
}

Option Command::number(std::string_view name, std::optional<double>& value, std::string_view help) const {
    const auto read = [&value, name = std::string(name)](const std::string& s) {
        value = scan_number<double>(s);
        if (!value) wrong_usage(text(name, " needs a number, found \"", s, "\""));
    };
    return use(name, read, help, "NUMBER");
}

Option Command::positive(std::string_view name, std::optional<double>& value, std::string_view help) const {
    return use(name, positive_number(std::string(name), value), help, "NUMBER");
}

Option Command::optional_value(std::string_view name, std::function<void(const std::string&)> read,
                               std::string_view help, std::string_view shown_as) const {
    CLI::Option& o = app_->add(name, help, std::move(read));
    o.least = 0;
    return Option(o).shown_as(shown_as);
}

Option Command::count(std::string_view name, std::optional<int>& value, int least, int most,
                      std::string_view help) const {
    const auto read = [&value, name = std::string(name), least, most](const std::string& s) {
        value = scan_number<int>(s);
        if (!value || *value < least || *value > most)
            wrong_usage(
                text(name, " needs a whole number from ", least, " to ", most, ", found \"", s, "\""));
    };
    return use(name, read, help, "N");
}

Option Command::numbers(std::string_view name, std::vector<double>& values, std::string_view help) const {
    const auto read = [&values, name = std::string(name)](const std::string& s) {
        std::string_view rest = s;
        do {
            const std::string_view part = trimmed(next_part(rest, ','));
            const auto x = scan_number<double>(part);
            if (!x) wrong_usage(text(name, " needs numbers separated by commas, found \"", part, "\""));
            values.push_back(*x);
        } while (!rest.empty());
    };
    return use(name, read, help, "NUMBER,...");
}

Option Command::file(std::string& value) const {
    return word("FILE", value, "The file").shown_as("FILE").required();
}
Option Command::points_file(std::string& value) const {
    return word("POINTS", value, "The file with the points").shown_as("FILE").required();
}
Option Command::object(std::string& value) const {
    return word("--object", value, "Only the object of this name or index").shown_as("NAME|INDEX");
}
void Command::answer_file() const {
    word("-o,--output", context_->output, "Where the answer goes").shown_as("FILE");
}
void Command::output(std::string_view what) const {
    word("-o,--output", context_->output, what).shown_as("FILE");
    word("--to", context_->to, "Format of the output, if its name does not say it").shown_as("FORMAT");
}

void Command::limits() const {
    Limits& limits = context_->limits;
    use("--timeout", positive_number("--timeout", limits.timeout), "Stop after this many seconds", "SECONDS");
    use("--max-memory", positive_number("--max-memory", limits.max_memory), "Refuse larger files", "BYTES");
    word("--reader", limits.reader, "What reads STEP files: freiform; there is no other reader here")
        .shown_as("READER")
        .one_of({"freiform", "occt"});
    flag("--repair", limits.repair, "Make right what is wrong in a STEP file, and say what was done");
    positive("--repair-limit", limits.repair_limit, "The longest gap that --repair closes");
}

void Command::triangle_limit() const {
    use("--max-triangles", positive_number("--max-triangles", context_->limits.max_triangles),
        text("Refuse to make more triangles than this (", context_->limits.max_triangles, ")"), "N");
}

void Command::act(std::function<Result<void>(Context&)>&& run) const {
    app_->act = [&context = *context_, run = std::move(run)] {
        context.action = [&context, run] { return run(context); };
    };
}

// The program
// ------------------------------------------------------------------------------------------------

CommandLine::CommandLine(Context& context, std::string_view name, std::string_view description,
                         std::string_view footer)
    : context_(context), app_(std::make_unique<CLI::App>()) {
    app_->name = name, app_->description = description, app_->footer = footer;
}
CommandLine::~CommandLine() = default;

Command CommandLine::program() const { return {*app_, context_}; }

Command CommandLine::add(std::string_view name, std::string_view description, std::string_view examples) {
    app_->commands.push_back(std::make_unique<CLI::App>());
    CLI::App& app = *app_->commands.back();
    app.name = name, app.description = description, app.footer = examples;
    const Command command(app, context_);
    command.flag("--json", context_.json, "Print the result, or the refusal, as one JSON object");
    return command;
}

std::expected<std::string, std::string> CommandLine::understand(std::vector<std::string> arguments) {
    if (arguments.size() == 1 && arguments[0] == "--describe") return described(*app_);
    const bool help =
        std::ranges::any_of(arguments, [](const auto& a) { return a == "-h" || a == "--help"; });
    const auto first = std::ranges::find_if_not(arguments, is_option);
    if (first == arguments.end()) return help ? help_of(*app_) : "";
    const auto used = std::ranges::find(app_->commands, *first, [](const auto& c) { return c->name; });
    if (used == app_->commands.end()) {
        std::vector<std::string_view> known;
        for (const auto& c : app_->commands) known.push_back(c->name);
        return std::unexpected(text("there is no command \"", *first, "\"", did_you_mean(*first, known),
                                    " (freiform --help lists them)"));
    }
    if (help) return help_of_command(**used);
    arguments.erase(first);
    if (auto wrong = Reader{**used, arguments}.read()) return std::unexpected(*std::move(wrong));
    if ((*used)->act) (*used)->act();
    return "";
}

std::string described(const CLI::App& program) {
    json::Writer w;
    w.begin_array();
    for (const auto& c : program.commands) {
        w.begin_object().field("name", c->name).field("description", c->description);
        w.field("examples", c->footer).key("options").begin_array();
        for (const auto& o : c->options) {
            w.begin_object().field("name", o->name()).field("value", o->shown_as).field("help", o->help);
            w.field("required", int(o->is_required)).key("words").begin_array();
            for (const std::string& word : o->words) w.value(word);
            w.end_array().end_object();
        }
        w.end_array().end_object();
    }
    return w.end_array().take();
}

}  // namespace freiform::cli

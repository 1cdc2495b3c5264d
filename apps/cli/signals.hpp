// How the program ends when it does not end by itself: signals, and the limits on time and memory.
#pragma once
#include "command.hpp"

namespace freiform::cli {

// SIGINT: 130, SIGTERM: 143, after unfinished files have been removed. A reader of standard output that goes
// away is not an error worth a message.
void catch_signals();

// Exits with 4, and says so like any other refusal, when the time is over or memory runs out.
void enforce(const Context& context);

}  // namespace freiform::cli

// The program: understands the arguments, runs one command, turns its refusal into a message and an exit
// code.
#pragma once
#include "command.hpp"

namespace freiform::cli {

int run(std::vector<std::string> arguments);

}  // namespace freiform::cli

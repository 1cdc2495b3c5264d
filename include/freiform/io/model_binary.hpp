// A model as bytes, exact to the last bit: what a reader in another process hands over, and what a cache
// keeps.
#pragma once
#include <freiform/model/model.hpp>

#include <string>
#include <string_view>

namespace freiform {

// The whole model, refusals and approximations included. The same model gives the same bytes on every
// machine.
std::string to_binary(const Model& model);

// The model that `to_binary` wrote. Any bytes may be given: what is not such a model is a refusal that names
// the byte, and memory is taken only for what the bytes hold. The result is checked as by `make_model`.
Result<Model> from_binary(std::string_view bytes);

}  // namespace freiform

// The document: freiform's own file format, JSON. docs/document.md describes every field.
#pragma once
#include <freiform/shape.hpp>

#include <string>
#include <string_view>

namespace freiform {

// Every refusal names the object, the field and the index ("objects[2].knots[3]"), or line and column where
// the text is not JSON. Time and memory are proportional to the text.
Result<Document> read_document(std::string_view json);

// Reads back to the same document, to the last bit of every number. Text that is not UTF-8 loses what is not.
std::string write_document(const Document& document);

}  // namespace freiform

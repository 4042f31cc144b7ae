// The description of the API: one document, put together from the pieces in server/http/openapi,
// a file for each resource.
#pragma once

#include <string>
#include <vector>

#include "server/json/json.h"

namespace stagger::server {

struct OpenApiPiece {
  std::string file;
  std::string text;
};

/// The pieces that are built into the program, in the order of their names.
const std::vector<OpenApiPiece>& openapi_pieces();

/// One OpenAPI 3.1 document. Objects are joined, lists too; what two pieces say of one thing is an
/// error: std::runtime_error that names the file.
Json openapi_document(const std::vector<OpenApiPiece>& pieces, const std::string& version);

}  // namespace stagger::server

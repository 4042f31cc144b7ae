#include "server/http/openapi.h"

#include <stdexcept>

namespace stagger::server {
namespace {

void join(Json& whole, const Json& piece, const std::string& where) {
  for (const auto& [name, value] : piece.items()) {
    std::string here = where;
    here += '/';
    here += name;
    if (!whole.contains(name)) {
      whole[name] = value;
    } else if (whole[name].is_object() && value.is_object()) {
      join(whole[name], value, here);
    } else if (whole[name].is_array() && value.is_array()) {
      for (const Json& item : value) whole[name].push_back(item);
    } else {
      throw std::runtime_error(here + " is there already");
    }
  }
}

}  // namespace

Json openapi_document(const std::vector<OpenApiPiece>& pieces, const std::string& version) {
  Json document = Json::object();
  for (const OpenApiPiece& piece : pieces) {
    try {
      join(document, Json::parse(piece.text), piece.file + ": ");
    } catch (const Json::parse_error& error) {
      throw std::runtime_error(piece.file + ": " + error.what());
    }
  }
  document["info"]["version"] = version;
  return document;
}

}  // namespace stagger::server

#include "server/json/terrain_json.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/json_file.h"

namespace stagger::server {
namespace {

using sim::Range;
using sim::TerrainKind;
using Terrain = sim::TerrainParameters;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double latest_shove = 1e6;  // [s]

const sim::Names<TerrainKind>& terrain_kinds() {
  static const sim::Names<TerrainKind> names{{"flat", TerrainKind::flat},
                                             {"slope", TerrainKind::slope},
                                             {"uneven", TerrainKind::uneven},
                                             {"platform", TerrainKind::platform}};
  return names;
}

Range friction_range() { return Range::between(Terrain::least_friction, Terrain::most_friction); }

Range count_range() { return Range::between(0, static_cast<double>(Terrain::most_items)); }

sim::FrictionPatch read_patch(sim::JsonReader& reader) {
  sim::FrictionPatch patch;
  const auto corner = [&reader](const char* name, double least) {
    return reader.number(name, Range::between(least, Terrain::most_distance, "m"));
  };
  patch.low.x() = corner("x_min", -Terrain::most_distance);
  patch.high.x() = corner("x_max", patch.low.x());
  patch.low.y() = corner("y_min", -Terrain::most_distance);
  patch.high.y() = corner("y_max", patch.low.y());
  patch.friction = reader.number("friction", friction_range());
  return patch;
}

/// Two fields that are a vector, together at most `most` long.
sim::Vec2 read_vector(sim::JsonReader& reader, const char* x, const char* y, double most,
                      const char* unit) {
  const Range range = Range::between(-most, most, unit);
  const sim::Vec2 vector(reader.number_or(x, 0.0, range), reader.number_or(y, 0.0, range));
  if (vector.norm() > most) {
    reader.refuse(x, "is " + to_text(vector.norm()) + " together with " + y + "; allowed: up to " +
                         to_text(most) + " " + unit);
  }
  return vector;
}

sim::PlatformShove read_shove(sim::JsonReader& reader) {
  sim::PlatformShove shove;
  shove.at_s = reader.number("at_s", Range::between(0.0, latest_shove, "s"));
  shove.duration_s = reader.number_or(
      "duration_s", shove.duration_s,
      Range::between(Terrain::least_shove_duration, Terrain::most_shove_duration, "s"));
  shove.displacement = read_vector(reader, "x_m", "y_m", Terrain::most_shove, "m");
  return shove;
}

}  // namespace

sim::TerrainParameters read_terrain(sim::JsonReader& reader) {
  Terrain terrain;
  terrain.kind = reader.one_of("kind", terrain_kinds());
  terrain.friction = reader.number_or("friction", terrain.friction, friction_range());
  if (reader.value("patches") != nullptr) {
    reader.object_list("patches", count_range(), [&terrain](sim::JsonReader& patch) {
      terrain.patches.push_back(read_patch(patch));
    });
  }
  switch (terrain.kind) {
    case TerrainKind::flat:
      break;
    case TerrainKind::slope:
      terrain.slope_angle =
          degree *
          reader.number("angle_deg", Range::between(0.0, Terrain::most_slope_deg, "degrees"));
      terrain.uphill_angle =
          degree * reader.number_or("uphill_deg", 0.0, Range::between(-360.0, 360.0, "degrees"));
      break;
    case TerrainKind::uneven:
      terrain.unevenness =
          reader.number("height_m", Range::between(0.0, Terrain::most_unevenness, "m"));
      break;
    case TerrainKind::platform:
      terrain.platform_velocity =
          read_vector(reader, "vx", "vy", Terrain::most_platform_speed, "m/s");
      if (reader.value("shoves") != nullptr) {
        reader.object_list("shoves", count_range(), [&terrain](sim::JsonReader& shove) {
          terrain.shoves.push_back(read_shove(shove));
        });
      }
      break;
  }
  return terrain;
}

Json terrain_json(const sim::TerrainParameters& terrain) {
  std::string_view kind;
  for (const auto& [name, value] : terrain_kinds()) {
    if (value == terrain.kind) kind = name;
  }
  Json patches = Json::array();
  for (const sim::FrictionPatch& patch : terrain.patches) {
    patches.push_back({{"x_min", patch.low.x()},
                       {"x_max", patch.high.x()},
                       {"y_min", patch.low.y()},
                       {"y_max", patch.high.y()},
                       {"friction", patch.friction}});
  }
  Json json{{"kind", kind}, {"friction", terrain.friction}, {"patches", std::move(patches)}};
  switch (terrain.kind) {
    case TerrainKind::flat:
      break;
    case TerrainKind::slope:
      json["angle_deg"] = terrain.slope_angle / degree;
      json["uphill_deg"] = terrain.uphill_angle / degree;
      break;
    case TerrainKind::uneven:
      json["height_m"] = terrain.unevenness;
      break;
    case TerrainKind::platform: {
      json["vx"] = terrain.platform_velocity.x();
      json["vy"] = terrain.platform_velocity.y();
      Json shoves = Json::array();
      for (const sim::PlatformShove& shove : terrain.shoves) {
        shoves.push_back({{"at_s", shove.at_s},
                          {"duration_s", shove.duration_s},
                          {"x_m", shove.displacement.x()},
                          {"y_m", shove.displacement.y()}});
      }
      json["shoves"] = std::move(shoves);
      break;
    }
  }
  return json;
}

void refuse_terrain_of_lipm(sim::JsonReader& reader, sim::PlantKind plant,
                            const sim::TerrainParameters& terrain) {
  if (plant != sim::PlantKind::lipm || terrain.kind == TerrainKind::flat) return;
  reader.refuse("terrain", "is not flat; allowed on the plant \"lipm\": \"flat\"");
}

sim::TerrainParameters parse_terrain(const std::string& text, sim::JsonErrors& errors) {
  nlohmann::json json;
  const std::size_t colon = text.find(':');
  if (text.starts_with("{")) {
    json = sim::parse_json(text);
  } else {
    json["kind"] = text.substr(0, colon);
    if (colon != std::string::npos) {
      const std::string rest = text.substr(colon + 1);
      const std::size_t second = rest.find(':');
      const bool slope = json["kind"] == "slope";
      json[slope ? "angle_deg" : "height_m"] = sim::parse_json(rest.substr(0, second));
      if (second != std::string::npos) {
        json["uphill_deg"] = sim::parse_json(rest.substr(second + 1));
      }
    }
  }
  sim::TerrainParameters terrain;
  sim::read_json(json, errors,
                 [&terrain](sim::JsonReader& reader) { terrain = read_terrain(reader); });
  return terrain;
}

}  // namespace stagger::server

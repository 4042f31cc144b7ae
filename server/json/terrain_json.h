// The terrain, in trials, requests and answers.
#pragma once

#include <string>

#include "server/json/json.h"
#include "sim/plant/plant.h"
#include "sim/plant/terrain.h"
#include "sim/strict_json.h"

namespace stagger::server {

/// {"kind":"flat"|"slope"|"uneven"|"platform", ...}: docs/trial.md has the fields of each kind.
sim::TerrainParameters read_terrain(sim::JsonReader& reader);
/// Every field of its kind; reading it again gives the same terrain.
Json terrain_json(const sim::TerrainParameters& terrain);

/// Adds an error when the plant cannot walk on that terrain: the point mass knows flat ground
/// alone.
void refuse_terrain_of_lipm(sim::JsonReader& reader, sim::PlantKind plant,
                            const sim::TerrainParameters& terrain);

/// A terrain for the command line: the same as JSON, or "flat", "slope:ANGLE", "slope:ANGLE:UPHILL"
/// in degrees, "uneven:HEIGHT" in metres. Throws sim::JsonSyntaxError for a text that is neither.
sim::TerrainParameters parse_terrain(const std::string& text, sim::JsonErrors& errors);

}  // namespace stagger::server

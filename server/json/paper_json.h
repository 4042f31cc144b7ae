// What `stagger paper --json` prints; docs/paper.md explains every key.
#pragma once

#include "server/json/json.h"
#include "sim/experiment/paper/paper.h"

namespace stagger::server {

/// One object with a key for each section that was run.
Json paper_json(const sim::PaperResults& results);

}  // namespace stagger::server

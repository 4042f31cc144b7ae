// After a process was killed: files that were cut off are finished, and the catalogue is made to
// agree with the files.
#pragma once

#include <filesystem>

#include "server/presence.h"
#include "server/recording/catalogue.h"

namespace stagger::server {

/// What can be told of a recording from its file alone. Throws std::runtime_error when it is none.
RecordingInfo summary_of(const std::filesystem::path& file);

/// What other servers that live are at, and files that are no recordings, are left alone. While it
/// runs nobody else may repair the folder.
void repair_recordings(const std::filesystem::path& folder, const Presence& presence,
                       Catalogue& catalogue);
/// One that its server has left behind. It has its file, or was armed in vain: then it is gone.
void repair_recording(const std::filesystem::path& file, Catalogue& catalogue);

}  // namespace stagger::server

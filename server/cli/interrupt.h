// Ctrl-C asks a long command to come to an end.
#pragma once

namespace stagger::server {

/// From now on SIGINT and SIGTERM ask once; a second one ends the process at once.
void listen_for_interrupts();
/// Has the process been asked? Safe to call from any thread.
bool interrupted();

}  // namespace stagger::server

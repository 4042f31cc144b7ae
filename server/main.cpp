#include "server/cli/cli.h"

int main(int argc, char** argv) { return stagger::server::run_command_line(argc, argv); }

// The command line: reads it and hands over to one command.
#pragma once

namespace stagger::server {

/// Exit codes of every command; 1 is the command's own "no" (the robot fell, ...).
enum ExitCode : int {
  exit_ok = 0,
  exit_no = 1,
  exit_usage = 2,         ///< bad options or a bad specification
  exit_transport = 3,     ///< the address cannot be served
  exit_invalid = 4,       ///< a trial that says nothing
  exit_interrupted = 130  ///< stopped by Ctrl-C before there was a result
};

/// Runs the command that argv asks for; returns the process's exit code.
int run_command_line(int argc, char** argv);

}  // namespace stagger::server

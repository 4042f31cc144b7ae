# Shared by the scripts; sourced with the checkout as the working directory.

log_dir=build/log

# quietly NAME COMMAND...: runs the command with its output in build/log/NAME.log, and shows the log's end if it fails.
quietly() {
  local name=$1 log=$log_dir/$1.log
  shift
  mkdir -p "$log_dir"
  if ! "$@" >"$log" 2>&1 </dev/null; then
    tail -n 60 "$log" >&2
    echo "$name: failed: $* (whole output: $log)" >&2
    return 1
  fi
}

# Our own C++ files, one a line.
cpp_files() { find engine sim server tests -name node_modules -prune -o \( -name '*.cpp' -o -name '*.h' \) -print | sort; }

# cpp-httplib, from the first release that is settled on WebSocket: an installed package, else the header that
# scripts/fetch-httplib leaves in third_party/, else upstream's tag. All three end up as httplib::httplib.

find_package(httplib 0.41 CONFIG QUIET)
if(NOT TARGET httplib::httplib)
  set(httplib_dir "${PROJECT_SOURCE_DIR}/third_party/cpp-httplib")
  if(NOT EXISTS "${httplib_dir}/httplib.h")
    include(FetchContent)
    FetchContent_Declare(cpp_httplib
      GIT_REPOSITORY https://github.com/yhirose/cpp-httplib.git
      GIT_TAG v0.41.0
      GIT_SHALLOW ON)
    # Only the header is wanted: its own CMakeLists.txt would look for compressors and TLS.
    FetchContent_GetProperties(cpp_httplib)
    if(NOT cpp_httplib_POPULATED)
      FetchContent_Populate(cpp_httplib)
    endif()
    set(httplib_dir "${cpp_httplib_SOURCE_DIR}")
  endif()
  find_package(Threads REQUIRED)
  add_library(httplib INTERFACE)
  add_library(httplib::httplib ALIAS httplib)
  target_include_directories(httplib SYSTEM INTERFACE "${httplib_dir}")
  target_link_libraries(httplib INTERFACE Threads::Threads)
endif()

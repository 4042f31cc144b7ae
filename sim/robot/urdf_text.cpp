#include "sim/robot/urdf_text.h"

#include <console_bridge/console.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <stdexcept>

namespace stagger::sim {
namespace {

constexpr std::size_t most_bytes = 64U << 20U;
constexpr int most_nesting = 64;
constexpr std::size_t most_links = 5000;
constexpr std::size_t most_messages = 20;

/// Keeps what urdfdom says instead of letting it write to standard error.
class Listener : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/,
           int /*line*/) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_WARN || messages.size() >= most_messages) return;
    if (messages.empty() || messages.back() != text) messages.push_back(text);
  }
  std::vector<std::string> messages;
};

/// How deep the elements of the text are nested at most, roughly: comments count as text, and a
/// reader that goes down with every element must not be sent down without end.
int nesting(const std::string& xml) {
  int depth = 0;
  int deepest = 0;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    const char next = at + 1 < xml.size() ? xml[at + 1] : '\0';
    if (next == '!' || next == '?') continue;
    if (next == '/') {
      --depth;
      continue;
    }
    const std::size_t end = xml.find('>', at);
    if (end != std::string::npos && xml[end - 1] == '/') continue;
    deepest = std::max(deepest, ++depth);
  }
  return deepest;
}

std::string check_tree(const urdf::ModelInterface& urdf) {
  if (urdf.links_.size() > most_links) {
    return "has " + std::to_string(urdf.links_.size()) + " links; allowed: at most " +
           std::to_string(most_links);
  }
  std::map<std::string, std::string> carried;  // link -> the joint that carries it
  for (const auto& [name, joint] : urdf.joints_) {
    if (joint->parent_link_name == joint->child_link_name) {
      return "joint '" + name + "' joins link '" + joint->child_link_name + "' to itself";
    }
    const auto [at, is_new] = carried.emplace(joint->child_link_name, name);
    if (!is_new) {
      return "link '" + joint->child_link_name + "' hangs on two joints, '" + at->second +
             "' and '" + name + "'; allowed: a tree";
    }
  }
  for (const auto& [link, carrier] : carried) {
    std::size_t steps = 0;
    for (auto at = carried.find(link); at != carried.end(); ++steps) {
      if (steps > carried.size()) {
        return "link '" + link + "' hangs on a ring of joints; allowed: a tree";
      }
      at = carried.find(urdf.joints_.at(at->second)->parent_link_name);
    }
  }
  return {};
}

}  // namespace

urdf::ModelInterfaceSharedPtr parse_urdf(const std::string& xml, const std::string& origin,
                                         std::vector<std::string>* warnings) {
  const auto refuse = [&](const std::string& what) {
    throw std::runtime_error(origin + ": " + what);
  };
  if (xml.size() > most_bytes) refuse("is greater than 64 MB");
  if (nesting(xml) > most_nesting) {
    refuse("nests its elements deeper than " + std::to_string(most_nesting));
  }
  // urdfdom's messages go to one place for the whole program.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  Listener listener;
  console_bridge::useOutputHandler(&listener);
  urdf::ModelInterfaceSharedPtr urdf;
  try {
    urdf = urdf::parseURDF(xml);
  } catch (const std::exception& error) {
    listener.messages.emplace_back(error.what());
  }
  console_bridge::restorePreviousOutputHandler();
  // urdfdom goes on without an inertia or a shape that it could not read; a robot does not.
  const bool lost = std::any_of(listener.messages.begin(), listener.messages.end(),
                                [](const std::string& message) {
                                  return message.starts_with("Could not parse inertial") ||
                                         message.starts_with("Could not parse collision");
                                });
  if (!urdf || !urdf->getRoot() || lost) {
    std::string said;
    for (const std::string& message : listener.messages) said += "; " + message;
    refuse("is no URDF that can be read" + said);
  }
  if (const std::string fault = check_tree(*urdf); !fault.empty()) refuse(fault);
  if (warnings != nullptr) *warnings = std::move(listener.messages);
  return urdf;
}

}  // namespace stagger::sim

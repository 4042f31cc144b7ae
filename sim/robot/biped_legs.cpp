#include "sim/robot/biped_legs.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "sim/robot/support_points.h"

namespace stagger::sim {
namespace {

using engine::Side;

constexpr std::size_t least_leg_joints = 5;
/// Ends that are this share of the robot's height above the lowest one do not stand on the ground.
constexpr double level_share = 0.05;
/// A joint this far (share of the height) from the one before it, in a body whose own parent
/// reaches the ground as well, is one of the toes.
constexpr double toe_share = 0.05;
/// An axis with less than this along its main direction is called skewed.
constexpr double straight = 0.95;
/// An axis is a pitch axis when it points at least this much to the side.
constexpr double sideways = 0.7;

/// A leg as bodies of the survey, from the one that hangs off the base to the foot.
using Chain = std::vector<int>;

struct Line {
  Vec3 point;
  Vec3 direction;
};

/// The point with the least sum of squared distances to the lines, drawn slightly towards their
/// points so that parallel lines have one too.
Vec3 meeting_point(const std::vector<Line>& lines) {
  constexpr double pull = 1e-4;
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vec3 b = Vec3::Zero();
  for (const Line& line : lines) {
    const Eigen::Matrix3d across =
        (1.0 + pull) * Eigen::Matrix3d::Identity() - line.direction * line.direction.transpose();
    a += across;
    b += across * line.point;
  }
  return a.ldlt().solve(b);
}

/// 1: `left` is the left one by the two names, -1: the right one, 0: they do not tell.
int side_by_name(const std::string& left, const std::string& right) {
  for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i) {
    const int a = std::tolower(static_cast<unsigned char>(left[i]));
    const int b = std::tolower(static_cast<unsigned char>(right[i]));
    if (a == b) continue;
    if (a == 'l' && b == 'r') return 1;
    if (a == 'r' && b == 'l') return -1;
    return 0;
  }
  return 0;
}

class LegFinder {
 public:
  LegFinder(const RobotModel& model, const ImportReport& report) : model_(model), report_(report) {
    RobotState zero;
    zero.q = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.joint_count()));
    poses_ = body_poses(model, zero);
    for (std::size_t i = 0; i < model.bodies.size(); ++i) measure(static_cast<int>(i));
  }

  Legs run() {
    PerBody feet = find_feet();
    chains_ = {chain_to(feet[0]), chain_to(feet[1])};
    // What both chains begin with is not part of a leg.
    while (!chains_[0].empty() && !chains_[1].empty() && chains_[0][0] == chains_[1][0]) {
      base_ = chains_[0][0];
      for (Chain& chain : chains_) chain.erase(chain.begin());
    }
    drop_mimics();
    for (const Chain& chain : chains_) check_chain(chain);
    find_axes();
    for (const Side side : {Side::left, Side::right}) {
      result_.leg[index(side)] = describe(chains_[index(side)]);
    }
    result_.base = base_link();
    if (base_ != 0) {
      tell("link '" + result_.base + "'",
           "both legs hang off it, not off the root '" + model_.bodies[0].name + "'",
           "taken as the base; the joints between are locked");
    }
    lock_the_rest();
    return std::move(result_);
  }

 private:
  using PerBody = std::array<int, 2>;

  void tell(std::string where, std::string what, std::string answer) {
    result_.quirks.push_back({std::move(where), std::move(what), std::move(answer)});
  }

  void measure(int body) {
    const Eigen::Isometry3d& pose = poses_[body];
    double low = pose.translation().z();
    const auto points = support_points(model_.bodies[body].shapes, pose, Vec3::UnitZ());
    for (const Vec3& point : points) {
      low = std::min(low, point.z());
      top_ = std::max(top_, point.z());
    }
    top_ = std::max(top_, pose.translation().z());
    low_.push_back(low);
    bottom_ = std::min(bottom_, low);
    parent_of_any_.resize(model_.bodies.size());
    if (body > 0) parent_of_any_[model_.bodies[body].parent] = true;
  }

  double height() const { return top_ - bottom_; }

  /// Toes move on a foot that stands on the ground without them.
  int foot_of(int end) const {
    while (model_.bodies[end].parent > 0) {
      const int parent = model_.bodies[end].parent;
      const Vec3 apart = poses_[end].translation() - poses_[parent].translation();
      const bool parent_stands =
          !model_.bodies[parent].shapes.empty() && low_[parent] < bottom_ + level_share * height();
      if (!parent_stands || apart.head<2>().norm() < toe_share * height()) break;
      end = parent;
    }
    return end;
  }

  PerBody find_feet() const {
    std::vector<int> feet;
    for (int i = 1; i < static_cast<int>(model_.bodies.size()); ++i) {
      if (parent_of_any_[i] || low_[i] > bottom_ + level_share * height()) continue;
      const int foot = foot_of(i);
      if (std::find(feet.begin(), feet.end(), foot) == feet.end()) feet.push_back(foot);
    }
    if (feet.size() == 2) return {feet[0], feet[1]};
    std::string text = "it has " + std::to_string(feet.size()) +
                       " ends of movable chains at the height of its lowest one";
    for (std::size_t i = 0; i < feet.size() && i < 8; ++i) {
      text += (i == 0 ? ": '" : ", '") + model_.bodies[feet[i]].name + "'";
    }
    throw CannotWalk(text + "; allowed: two legs that reach the ground at the zero pose");
  }

  Chain chain_to(int body) const {
    Chain chain;
    for (int i = body; i > 0; i = model_.bodies[i].parent) chain.insert(chain.begin(), i);
    return chain;
  }

  /// A joint that follows another has no motor of its own: it is held, and so is the one it
  /// follows.
  void drop_mimics() {
    for (const auto& [joint, master] : report_.mimics) {
      const auto is_leg = [&](const std::string& name) {
        const int body = model_.joint_index(name) + 1;
        return body > 0 && std::any_of(chains_.begin(), chains_.end(), [&](const Chain& chain) {
                 return std::find(chain.begin(), chain.end(), body) != chain.end();
               });
      };
      if (!is_leg(joint)) continue;
      tell("joint '" + joint + "'", "mimics '" + master + "': one motor for two joints",
           "both are locked");
      for (const std::string& name : {joint, master}) {
        const int body = model_.joint_index(name) + 1;
        for (Chain& chain : chains_) std::erase(chain, body);
      }
    }
  }

  void check_chain(const Chain& chain) const {
    const std::string who =
        "the leg that ends at '" + (chain.empty() ? "?" : model_.bodies[chain.back()].name) + "'";
    for (const auto& [joint, held] : report_.held) {
      if (std::find(chain.begin(), chain.end(), held.body) != chain.end()) {
        std::string text = who;
        text.append(" has the ").append(held.type).append(" joint '").append(joint);
        throw CannotWalk(text + "'; allowed: joints that turn");
      }
    }
    std::string passive;
    std::size_t driven = 0;
    for (const int body : chain) {
      if (model_.bodies[body].effort > 0.0) {
        ++driven;
      } else {
        passive += " '" + model_.bodies[body].joint + "'";
      }
    }
    // No effort at all in a leg: the file does not know them. Some without: these are passive.
    if (driven > 0 && driven < chain.size()) {
      throw CannotWalk(who + " has joints with effort 0 among driven ones:" + passive +
                       "; passive joints belong to closed loops, which a URDF does not carry");
    }
    if (chain.size() < least_leg_joints) {
      throw CannotWalk(who + " has " + std::to_string(chain.size()) +
                       " joints of its own; allowed: at least " + std::to_string(least_leg_joints));
    }
  }

  Vec3 axis_of(int body) const { return poses_[body].linear() * model_.bodies[body].axis; }
  Vec3 origin_of(int body) const { return poses_[body].translation(); }

  /// The pitch joint that is farthest from both ends; -1 when the leg has none.
  int knee_of(const Chain& chain, const Vec3& left) const {
    int best = -1;
    double best_distance = 0.0;
    for (const int body : chain) {
      if (std::abs(axis_of(body).dot(left)) < sideways) continue;
      const double distance = std::min((origin_of(body) - origin_of(chain.front())).norm(),
                                       (origin_of(body) - origin_of(chain.back())).norm());
      if (distance > best_distance) {
        best = body;
        best_distance = distance;
      }
    }
    return best;
  }

  void find_axes() {
    const auto across = [&](std::size_t i) {
      Vec3 apart = origin_of(chains_[0][i]) - origin_of(chains_[1][i]);
      apart.z() = 0.0;
      return apart;
    };
    const std::size_t shared = std::min(chains_[0].size(), chains_[1].size());
    Vec3 apart = Vec3::Zero();
    for (std::size_t i = 0; i < shared; ++i) apart += across(i);
    if (apart.norm() < 0.01 * height() * static_cast<double>(shared)) {
      throw CannotWalk("its legs are not beside each other at the zero pose");
    }
    // CAD leaves rounding errors: an axis of the root that is this near is meant.
    Vec3 left = apart.normalized();
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)}) {
      if (left.dot(axis) > std::cos(0.1)) left = axis;
    }
    int vote = 0;
    for (std::size_t i = 0; i < shared; ++i) {
      vote += side_by_name(model_.bodies[chains_[0][i]].joint, model_.bodies[chains_[1][i]].joint);
      vote += side_by_name(model_.bodies[chains_[0][i]].name, model_.bodies[chains_[1][i]].name);
    }
    const char* source = "the names";
    const int bend = vote_of_knees(left);
    if (vote == 0) {
      vote = bend;
      source = "the way the knees bend";
    } else if (vote * bend < 0) {
      tell("knees", "bend backwards, if the names of the sides are right", "the names count");
    }
    if (vote == 0) {
      vote = left.cross(Vec3::UnitZ()).x() >= 0.0 ? 1 : -1;
      source = "the root's x axis";
    }
    if (vote < 0) {
      left = -left;
      std::swap(chains_[0], chains_[1]);
    }
    result_.axes << left.cross(Vec3::UnitZ()), left, Vec3::UnitZ();
    if (result_.axes(0, 0) < 0.99) {
      std::ostringstream text;
      text << "forward is [" << result_.axes.col(0).transpose() << "] of the root, by " << source;
      tell("root", text.str(), "soles and torso get axes of their own");
    }
  }

  /// 1 when the knees would bend as a person's if `left` is to the left, -1 for the other way.
  int vote_of_knees(const Vec3& left) const {
    double sum = 0.0;
    for (const Chain& chain : chains_) {
      const int knee = knee_of(chain, left);
      if (knee < 0) continue;
      const Body& body = model_.bodies[knee];
      if (!std::isfinite(body.lower) || !std::isfinite(body.upper)) continue;
      // A positive turn about the left axis takes the shank backwards.
      sum += (axis_of(knee).dot(left) > 0.0 ? 1.0 : -1.0) * (body.upper + body.lower);
    }
    return sum > 0.1 ? 1 : sum < -0.1 ? -1 : 0;
  }

  Leg describe(const Chain& chain) {
    Leg leg;
    const int knee = knee_of(chain, result_.axes.col(1));
    const std::string end = model_.bodies[chain.back()].name;
    if (knee < 0) {
      throw CannotWalk("the leg that ends at '" + end +
                       "' has no knee: no joint in its middle turns about the axis to the side");
    }
    bool above = true;
    std::vector<Line> hip;
    std::vector<Line> ankle;
    for (const int body : chain) {
      LegJoint joint;
      joint.name = model_.bodies[body].joint;
      joint.axis = result_.axes.transpose() * axis_of(body);
      Eigen::Index main = 0;
      const double part = joint.axis.cwiseAbs().maxCoeff(&main);
      if (body == knee) {
        above = false;
        joint.role = LegRole::knee;
      } else {
        const LegRole hips[] = {LegRole::hip_roll, LegRole::hip_pitch, LegRole::hip_yaw};
        const LegRole ankles[] = {LegRole::ankle_roll, LegRole::ankle_pitch, LegRole::ankle_yaw};
        joint.role = above ? hips[main] : ankles[main];
        (above ? hip : ankle).push_back({origin_of(body), axis_of(body)});
      }
      if (part < straight) {
        std::ostringstream text;
        text << "its axis is skewed: [" << joint.axis.transpose() << "] along forward, left, up";
        tell("joint '" + joint.name + "'", text.str(),
             std::string("called ") + sim::name(joint.role) + "; control uses the axis as it is");
      }
      leg.joints.push_back(joint);
    }
    if (hip.empty() || ankle.empty()) {
      throw CannotWalk("the leg that ends at '" + end + "' has no joint " +
                       (hip.empty() ? "above" : "below") + " its knee");
    }
    leg.foot = end;
    leg.hip = meeting_point(hip);
    leg.ankle = meeting_point(ankle);
    // Of the knee's axis, the point between hip and ankle.
    const Vec3 middle = 0.5 * (leg.hip + leg.ankle);
    leg.knee = origin_of(knee) + axis_of(knee).dot(middle - origin_of(knee)) * axis_of(knee);
    tell_missing(leg);
    return leg;
  }

  void tell_missing(const Leg& leg) {
    if (!leg.has(LegRole::ankle_pitch)) {
      throw CannotWalk("the foot '" + leg.foot +
                       "' cannot be kept flat: no joint below the knee turns about the axis to "
                       "the side");
    }
    if (!leg.has(LegRole::ankle_roll)) {
      tell(
          "foot '" + leg.foot + "'", "no ankle roll joint",
          "stands as wide as its hips; with flat feet it cannot shift its weight, so do not expect "
          "it to walk here");
    }
    if (!leg.has(LegRole::hip_yaw)) {
      tell("foot '" + leg.foot + "'", "no hip yaw joint", "it is not able to turn its feet");
    }
  }

  std::string base_link() const {
    if (model_.links.at(model_.bodies[base_].name).mass > 0.0) return model_.bodies[base_].name;
    std::string best = model_.bodies[base_].name;
    double most = 0.0;
    for (const auto& [link, place] : model_.links) {
      if (place.body != base_ || place.mass <= most) continue;
      best = link;
      most = place.mass;
    }
    return best;
  }

  void lock_the_rest() {
    for (std::size_t i = 1; i < model_.bodies.size(); ++i) {
      const auto body = static_cast<int>(i);
      const bool used = std::any_of(chains_.begin(), chains_.end(), [&](const Chain& chain) {
        return std::find(chain.begin(), chain.end(), body) != chain.end();
      });
      if (!used) result_.locked.push_back(model_.bodies[i].joint);
    }
    for (const auto& [joint, held] : report_.held) result_.locked.push_back(joint);
    if (result_.locked.empty()) return;
    std::string names;
    for (std::size_t i = 0; i < result_.locked.size() && i < 4; ++i) {
      names += (i == 0 ? "'" : ", '") + result_.locked[i] + "'";
    }
    if (result_.locked.size() > 4) {
      names += " and " + std::to_string(result_.locked.size() - 4) + " more";
    }
    tell("joints " + names, "part of neither leg", "locked: nothing would control them");
  }

  const RobotModel& model_;
  const ImportReport& report_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<double> low_;  // lowest point of each body
  std::vector<bool> parent_of_any_;
  double bottom_ = std::numeric_limits<double>::infinity();
  double top_ = -std::numeric_limits<double>::infinity();
  int base_ = 0;
  engine::PerFoot<Chain> chains_;
  Legs result_;
};

}  // namespace

const char* name(LegRole role) {
  switch (role) {
    case LegRole::hip_yaw:
      return "hip_yaw";
    case LegRole::hip_roll:
      return "hip_roll";
    case LegRole::hip_pitch:
      return "hip_pitch";
    case LegRole::knee:
      return "knee";
    case LegRole::ankle_yaw:
      return "ankle_yaw";
    case LegRole::ankle_roll:
      return "ankle_roll";
    case LegRole::ankle_pitch:
      return "ankle_pitch";
  }
  return "";
}

bool Leg::has(LegRole role) const {
  return std::any_of(joints.begin(), joints.end(),
                     [&](const LegJoint& joint) { return joint.role == role; });
}

Legs find_legs(const RobotModel& model, const ImportReport& report) {
  return LegFinder(model, report).run();
}

}  // namespace stagger::sim

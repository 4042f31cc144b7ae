#include "sim/plant/bullet_world.h"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "sim/plant/body_pairs.h"
#include "sim/plant/bullet_ground.h"
#include "sim/plant/bullet_math.h"
#include "sim/plant/motor_limits.h"

namespace stagger::sim {
namespace {

// Rounding of shapes that Bullet's general convex algorithm sees; boxes on the ground are exact.
constexpr double collision_margin = 0.001;  // [m]
// Bullet rounds a hull outwards: the least that its general convex algorithm is content with.
constexpr double hull_margin = 1e-4;  // [m]
// Bodies without geometry still need a collider: Bullet 3.24 puts a body's joint limits into no
// island, and so ignores them, when it has none. These collide with nothing.
constexpr double stand_in_radius = 0.01;  // [m]

// Bullet cuts velocities here, and with them momentum: its 100 is what a light foot reaches when it
// is hit.
constexpr double max_coordinate_velocity = 1000.0;  // [m/s] and [rad/s]

// Of every body. Bullet multiplies coefficients: two bodies of the robot have 0.64 between them,
// and the ground carries what is missing to its own.
constexpr double robot_friction = 0.8;

constexpr int ground_group = 1;
constexpr int robot_group = 2;
constexpr int stand_in_group = 4;

/// Bullet's frame of a body: at its centre of mass, along its principal axes.
struct PrincipalFrame {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  // in the body's frame
  Vec3 moments = Vec3::Zero();                             // [kg m^2]
};

PrincipalFrame principal_frame(const Body& body) {
  PrincipalFrame frame;
  frame.pose.translation() = body.com;
  frame.moments = body.inertia.diagonal();
  const Eigen::Matrix3d rest = body.inertia - Eigen::Matrix3d(frame.moments.asDiagonal());
  if (rest.cwiseAbs().maxCoeff() == 0.0) return frame;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(body.inertia);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  frame.pose.linear() = axes;
  frame.moments = solver.eigenvalues();
  return frame;
}

std::unique_ptr<btCollisionShape> make_shape(const Shape& shape) {
  std::unique_ptr<btCollisionShape> result;
  switch (shape.kind) {
    case Shape::Kind::box:
      result = std::make_unique<btBoxShape>(to_bullet(Vec3(0.5 * shape.size)));
      break;
    case Shape::Kind::cylinder:
      result = std::make_unique<btCylinderShapeZ>(
          btVector3(shape.size.x(), shape.size.x(), 0.5 * shape.size.y()));
      break;
    case Shape::Kind::sphere:
      return std::make_unique<btSphereShape>(shape.size.x());  // its margin is its radius
    case Shape::Kind::hull: {
      auto hull = std::make_unique<btConvexHullShape>();
      for (const Vec3& point : shape.points) hull->addPoint(to_bullet(point), false);
      hull->recalcLocalAabb();
      // Bullet adds the margin outside a hull; what is thin stays thin.
      hull->setMargin(hull_margin);
      return hull;
    }
  }
  result->setMargin(std::min(collision_margin, 0.1 * shape.size.head(2).minCoeff()));
  return result;
}

/// Bullet asks it which pairs of objects may collide at all.
struct PairFilter final : btOverlapFilterCallback {
  explicit PairFilter(const RobotModel& model) : pairs(model) {}

  bool needBroadphaseCollision(btBroadphaseProxy* first, btBroadphaseProxy* second) const override {
    if ((first->m_collisionFilterGroup & second->m_collisionFilterMask) == 0 ||
        (second->m_collisionFilterGroup & first->m_collisionFilterMask) == 0) {
      return false;
    }
    const btMultiBodyLinkCollider* a = link(*first);
    const btMultiBodyLinkCollider* b = link(*second);
    return a == nullptr || b == nullptr || pairs.may_touch(a->m_link + 1, b->m_link + 1);
  }
  static const btMultiBodyLinkCollider* link(const btBroadphaseProxy& proxy) {
    return btMultiBodyLinkCollider::upcast(
        static_cast<const btCollisionObject*>(proxy.m_clientObject));
  }

  BodyPairs pairs;
};

/// Bullet's world, with the coefficient of friction chosen point by point.
struct World final : btMultiBodyDynamicsWorld {
  using btMultiBodyDynamicsWorld::btMultiBodyDynamicsWorld;

  void performDiscreteCollisionDetection() override {
    btMultiBodyDynamicsWorld::performDiscreteCollisionDetection();
    if (terrain != nullptr && !terrain->parameters().patches.empty()) set_frictions();
  }
  void set_frictions() {
    for (int m = 0; m < m_dispatcher1->getNumManifolds(); ++m) {
      btPersistentManifold& manifold = *m_dispatcher1->getManifoldByIndexInternal(m);
      if (btMultiBodyLinkCollider::upcast(manifold.getBody0()) != nullptr &&
          btMultiBodyLinkCollider::upcast(manifold.getBody1()) != nullptr) {
        continue;
      }
      for (int i = 0; i < manifold.getNumContacts(); ++i) {
        btManifoldPoint& point = manifold.getContactPoint(i);
        const btVector3& place = point.getPositionWorldOnA();
        point.m_combinedFriction = terrain->friction({place.x(), place.y()}, time);
      }
    }
  }

  const Terrain* terrain = nullptr;
  double time = 0.0;  // now [s]
};

/// Sees whether two objects touch.
struct TouchProbe final : btCollisionWorld::ContactResultCallback {
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    touches |= point.getDistance() <= 0.0;
    return 0.0;
  }
  bool touches = false;
};

void mix(StateHash& hash, const Vec3& v) {
  for (const double x : {v.x(), v.y(), v.z()}) hash.mix(x);
}

}  // namespace

// Members are destroyed last to first: the world goes before what it points to.
struct BulletWorld::Impl {
  Impl(const RobotModel& model_in, const PhysicsParameters& parameters_in,
       const Terrain& terrain_in)
      : model(model_in), parameters(parameters_in), terrain(terrain_in), filter(model_in) {}

  void make_world();
  void make_robot();
  void make_collider(int body, const Eigen::Isometry3d& pose);
  void separate_touching_pairs();
  void add_colliders();
  void make_joint_limits();
  void place(const RobotState& start);
  void apply_torque(const Eigen::VectorXd& torque);
  void apply_force(const AppliedForce& force);
  void read_state();
  void read_contacts();

  btCollisionShape* keep(std::unique_ptr<btCollisionShape> shape) {
    shapes.push_back(std::move(shape));
    return shapes.back().get();
  }
  // World pose of Bullet's frame of a body, now. The link's own cached transform is one step old.
  const btTransform& frame_now(int body) const { return colliders[body]->getWorldTransform(); }
  Vec3 world_point(const LinkPlace& place, const Vec3& in_link) const {
    const Vec3 in_frame = frames[place.body].pose.inverse() * (place.pose * in_link);
    return to_eigen(frame_now(place.body) * to_bullet(in_frame));
  }

  const RobotModel model;
  const PhysicsParameters parameters;
  const Terrain terrain;
  std::vector<PrincipalFrame> frames;
  RobotState state;
  Eigen::VectorXd applied_torque;
  std::vector<Contact> contacts;

  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  PairFilter filter;
  btDefaultCollisionConfiguration configuration;
  std::unique_ptr<btCollisionDispatcher> dispatcher;
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  std::unique_ptr<btMultiBody> robot;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> limits;
  std::unique_ptr<World> world;
  std::unique_ptr<BulletGround> ground;
  std::uint64_t steps = 0;  // done
};

void BulletWorld::Impl::make_world() {
  dispatcher = std::make_unique<btCollisionDispatcher>(&configuration);
  world = std::make_unique<World>(dispatcher.get(), &broadphase, &solver, &configuration);
  world->terrain = &terrain;
  world->getPairCache()->setOverlapFilterCallback(&filter);
  world->setGravity(btVector3(0.0, 0.0, -parameters.gravity));
  btContactSolverInfo& info = world->getSolverInfo();
  info.m_numIterations = parameters.iterations;
  // Bullet's default here, and not to be saved on: with one direction a foot at rest is held along
  // one axis only and creeps along the other.
  info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  ground =
      std::make_unique<BulletGround>(terrain, *world, ground_group, robot_group, robot_friction);
}

void BulletWorld::Impl::make_robot() {
  for (const Body& body : model.bodies) frames.push_back(principal_frame(body));
  const auto joints = static_cast<int>(model.joint_count());
  robot = std::make_unique<btMultiBody>(joints, model.bodies[0].mass, to_bullet(frames[0].moments),
                                        false, false);
  for (int i = 0; i < joints; ++i) {
    const Body& body = model.bodies[i + 1];
    const Eigen::Isometry3d& parent = frames[body.parent].pose;
    const Eigen::Isometry3d& own = frames[i + 1].pose;
    const Eigen::Matrix3d parent_to_own =
        (own.linear().transpose() * body.placement.linear().transpose()) * parent.linear();
    const Vec3 com_to_pivot =
        parent.linear().transpose() * (body.placement.translation() - parent.translation());
    const Vec3 pivot_to_com = own.linear().transpose() * own.translation();
    const Vec3 axis = own.linear().transpose() * body.axis;
    robot->setupRevolute(i, body.mass, to_bullet(frames[i + 1].moments), body.parent - 1,
                         to_bullet(Eigen::Quaterniond(parent_to_own)), to_bullet(axis),
                         to_bullet(com_to_pivot), to_bullet(pivot_to_com), true);
  }
  robot->finalizeMultiDof();
  robot->setLinearDamping(0.0);
  robot->setAngularDamping(0.0);
  robot->setCanSleep(false);
  robot->setMaxCoordinateVelocity(max_coordinate_velocity);
  robot->setHasSelfCollision(parameters.self_collision);
}

void BulletWorld::Impl::make_collider(int body, const Eigen::Isometry3d& pose) {
  auto collider = std::make_unique<btMultiBodyLinkCollider>(robot.get(), body - 1);
  const std::vector<Shape>& pieces = model.bodies[body].shapes;
  const Eigen::Isometry3d to_frame = frames[body].pose.inverse();
  if (pieces.empty()) {
    collider->setCollisionShape(keep(std::make_unique<btSphereShape>(stand_in_radius)));
  } else if (pieces.size() == 1 &&
             (to_frame * pieces[0].pose).isApprox(Eigen::Isometry3d::Identity(), 1e-12)) {
    collider->setCollisionShape(keep(make_shape(pieces[0])));
  } else {
    auto compound = std::make_unique<btCompoundShape>();
    for (const Shape& piece : pieces) {
      compound->addChildShape(to_bullet(to_frame * piece.pose), keep(make_shape(piece)));
    }
    collider->setCollisionShape(keep(std::move(compound)));
  }
  collider->setFriction(robot_friction);
  collider->setWorldTransform(to_bullet(pose * frames[body].pose));
  if (body == 0) {
    robot->setBaseCollider(collider.get());
  } else {
    robot->getLink(body - 1).m_collider = collider.get();
  }
  colliders.push_back(std::move(collider));
}

void BulletWorld::Impl::separate_touching_pairs() {
  for (const auto& [first, second] : filter.pairs.list()) {
    TouchProbe probe;
    world->contactPairTest(colliders[first].get(), colliders[second].get(), probe);
    if (probe.touches) filter.pairs.forbid(first, second);
  }
}

void BulletWorld::Impl::add_colliders() {
  const int partners = parameters.self_collision ? ground_group | robot_group : ground_group;
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    const bool stand_in = model.bodies[i].shapes.empty();
    world->addCollisionObject(colliders[i].get(), stand_in ? stand_in_group : robot_group,
                              stand_in ? 0 : partners);
  }
}

void BulletWorld::Impl::make_joint_limits() {
  for (int i = 0; i < robot->getNumLinks(); ++i) {
    const Body& body = model.bodies[i + 1];
    if (!std::isfinite(body.lower) || !std::isfinite(body.upper)) continue;
    auto limit =
        std::make_unique<btMultiBodyJointLimitConstraint>(robot.get(), i, body.lower, body.upper);
    world->addMultiBodyConstraint(limit.get());
    limit->finalizeMultiDof();
    limits.push_back(std::move(limit));
  }
}

void BulletWorld::Impl::place(const RobotState& start) {
  const Eigen::Quaterniond base = start.base_orientation.normalized();
  const Vec3 to_com = base * Vec3(frames[0].pose.translation());
  const Eigen::Quaterniond orientation = base * Eigen::Quaterniond(frames[0].pose.linear());
  robot->setBasePos(to_bullet(Vec3(start.base_position + to_com)));
  robot->setWorldToBaseRot(to_bullet(orientation).inverse());
  robot->setBaseVel(
      to_bullet(Vec3(start.base_velocity + start.base_angular_velocity.cross(to_com))));
  robot->setBaseOmega(to_bullet(start.base_angular_velocity));
  for (int i = 0; i < robot->getNumLinks(); ++i) {
    robot->setJointPos(i, start.q[i]);
    robot->setJointVel(i, start.qd[i]);
  }
}

void BulletWorld::Impl::apply_torque(const Eigen::VectorXd& torque) {
  for (int i = 0; i < robot->getNumLinks(); ++i) {
    const TorqueRange range = available_torque(model.bodies[i + 1], robot->getJointVel(i));
    applied_torque[i] = std::clamp(torque[i], range.lower, range.upper);
    robot->addJointTorque(i, applied_torque[i]);
  }
}

void BulletWorld::Impl::apply_force(const AppliedForce& force) {
  const auto found = model.links.find(force.link);
  assert(found != model.links.end());
  if (found == model.links.end()) return;
  const LinkPlace& place = found->second;
  const Vec3 point = world_point(place, force.point.value_or(place.com));
  const Vec3 arm = point - to_eigen(frame_now(place.body).getOrigin());
  const Vec3 torque = arm.cross(force.force);
  if (place.body == 0) {
    robot->addBaseForce(to_bullet(force.force));
    robot->addBaseTorque(to_bullet(torque));
  } else {
    robot->addLinkForce(place.body - 1, to_bullet(force.force));
    robot->addLinkTorque(place.body - 1, to_bullet(torque));
  }
}

void BulletWorld::Impl::read_state() {
  const Eigen::Quaterniond orientation = to_eigen(robot->getWorldToBaseRot().inverse());
  const Eigen::Quaterniond in_base(frames[0].pose.linear());
  state.base_orientation = (orientation * in_base.conjugate()).normalized();
  const Vec3 to_com = state.base_orientation * Vec3(frames[0].pose.translation());
  state.base_position = to_eigen(robot->getBasePos()) - to_com;
  state.base_angular_velocity = to_eigen(robot->getBaseOmega());
  state.base_velocity = to_eigen(robot->getBaseVel()) - state.base_angular_velocity.cross(to_com);
  for (int i = 0; i < robot->getNumLinks(); ++i) {
    state.q[i] = robot->getJointPos(i);
    state.qd[i] = robot->getJointVel(i);
  }
}

void BulletWorld::Impl::read_contacts() {
  contacts.clear();
  for (int m = 0; m < dispatcher->getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(m);
    const btMultiBodyLinkCollider* first = btMultiBodyLinkCollider::upcast(manifold.getBody0());
    const btMultiBodyLinkCollider* second = btMultiBodyLinkCollider::upcast(manifold.getBody1());
    const btMultiBodyLinkCollider* collider = first ? first : second;
    if (!collider) continue;
    const int other = first && second ? second->m_link + 1 : Contact::ground;
    // Impulses act on body 0, the normal points to it; body 1 gets the opposite.
    const double sign = (first ? 1.0 : -1.0) / parameters.dt;
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      if (!(point.m_appliedImpulse > 0.0)) continue;
      const btVector3 impulse = point.m_normalWorldOnB * point.m_appliedImpulse +
                                point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                                point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
      const btVector3& where = first ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
      contacts.push_back({collider->m_link + 1, to_eigen(where), sign * to_eigen(impulse), other});
    }
  }
}

BulletWorld::BulletWorld(const RobotModel& model, const RobotState& start,
                         const PhysicsParameters& parameters, const Terrain& terrain)
    : impl_(std::make_unique<Impl>(model, parameters, terrain)) {
  const auto joints = static_cast<Eigen::Index>(model.joint_count());
  assert(start.q.size() == joints && start.qd.size() == joints);
  impl_->state = start;
  impl_->applied_torque = Eigen::VectorXd::Zero(joints);
  impl_->contacts.reserve(64);
  impl_->make_world();
  impl_->make_robot();
  impl_->place(start);
  const auto poses = body_poses(model, start);
  for (int i = 0; i <= joints; ++i) impl_->make_collider(i, poses[i]);
  if (parameters.self_collision) impl_->separate_touching_pairs();
  impl_->add_colliders();
  impl_->world->addMultiBody(impl_->robot.get());
  impl_->make_joint_limits();
}

BulletWorld::~BulletWorld() {
  Impl& impl = *impl_;
  for (const auto& limit : impl.limits) impl.world->removeMultiBodyConstraint(limit.get());
  impl.world->removeMultiBody(impl.robot.get());
  for (const auto& collider : impl.colliders) impl.world->removeCollisionObject(collider.get());
}

void BulletWorld::step(const Eigen::VectorXd& torque, std::span<const AppliedForce> forces) {
  assert(torque.size() == impl_->applied_torque.size());
  // Bullet forgets forces and torques after every step.
  impl_->apply_torque(torque);
  for (const AppliedForce& force : forces) impl_->apply_force(force);
  const double dt = impl_->parameters.dt;
  impl_->world->time = static_cast<double>(impl_->steps) * dt;
  ++impl_->steps;
  impl_->ground->prepare(static_cast<double>(impl_->steps) * dt,
                         impl_->state.base_position.head<2>());
  impl_->world->stepSimulation(dt, 0);
  impl_->read_state();
  impl_->read_contacts();
}

const RobotState& BulletWorld::state() const { return impl_->state; }
const Eigen::VectorXd& BulletWorld::applied_torque() const { return impl_->applied_torque; }
std::span<const BulletWorld::Contact> BulletWorld::contacts() const { return impl_->contacts; }
const PhysicsParameters& BulletWorld::parameters() const { return impl_->parameters; }

bool BulletWorld::touches_ground(int body) const {
  for (const Contact& contact : impl_->contacts) {
    if (contact.body == body && contact.with_ground()) return true;
  }
  return false;
}

Vec3 BulletWorld::application_point(const AppliedForce& force) const {
  const LinkPlace& place = impl_->model.links.at(force.link);
  return impl_->world_point(place, force.point.value_or(place.com));
}

void BulletWorld::mix_state(StateHash& hash) const {
  const RobotState& state = impl_->state;
  mix(hash, state.base_position);
  for (const double x : state.base_orientation.coeffs()) hash.mix(x);
  mix(hash, state.base_velocity);
  mix(hash, state.base_angular_velocity);
  for (const double x : state.q) hash.mix(x);
  for (const double x : state.qd) hash.mix(x);
  for (const Contact& contact : impl_->contacts) {
    hash.mix(static_cast<std::uint64_t>(contact.body));
    mix(hash, contact.point);
    mix(hash, contact.force);
  }
}

}  // namespace stagger::sim

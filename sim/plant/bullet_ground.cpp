#include "sim/plant/bullet_ground.h"

#include <cmath>

#include "sim/plant/bullet_math.h"

namespace stagger::sim {
namespace {

// In double precision a box of this size still has its face exact to 1e-13 m.
constexpr double half_extent = 1000.0;  // [m]
constexpr double half_depth = 1.0;      // [m]

/// Tiles of a side of the square around the robot: it sees 2 m and more each way, which is farther
/// than it is tall.
constexpr std::int64_t tiles_a_side = 10;
constexpr double tile_half_depth = 0.25;  // [m]

/// Turns the upward axis to the normal.
btQuaternion tilt(const Vec3& normal) {
  if (normal == Vec3::UnitZ()) return btQuaternion::getIdentity();
  return shortestArcQuat(btVector3(0.0, 0.0, 1.0), to_bullet(normal));
}

/// The place in [first, first + tiles_a_side) that the same object of the ring serves.
std::int64_t wrapped(std::int64_t index, std::int64_t first) {
  const std::int64_t rest = (index - first) % tiles_a_side;
  return first + (rest < 0 ? rest + tiles_a_side : rest);
}

}  // namespace

BulletGround::BulletGround(const Terrain& terrain, btMultiBodyDynamicsWorld& world, int group,
                           int mask, double friction)
    : terrain_(terrain), world_(world) {
  const double own = terrain.parameters().friction / friction;
  switch (terrain.parameters().kind) {
    case TerrainKind::flat:
    case TerrainKind::slope:
      make_box(group, mask, own);
      break;
    case TerrainKind::platform:
      make_platform(group, mask, own);
      break;
    case TerrainKind::uneven:
      make_tiles(group, mask, own);
      break;
  }
}

BulletGround::~BulletGround() {
  if (box_) world_.removeCollisionObject(box_.get());
  if (platform_) world_.removeRigidBody(platform_.get());
  for (const Tile& tile : tiles_) world_.removeCollisionObject(tile.object.get());
}

void BulletGround::make_box(int group, int mask, double friction) {
  shape_ = std::make_unique<btBoxShape>(btVector3(half_extent, half_extent, half_depth));
  box_ = std::make_unique<btCollisionObject>();
  box_->setCollisionShape(shape_.get());
  const Vec3 normal = terrain_.normal();
  box_->setWorldTransform(btTransform(tilt(normal), to_bullet(Vec3(-half_depth * normal))));
  box_->setFriction(friction);
  world_.addCollisionObject(box_.get(), group, mask);
}

void BulletGround::make_platform(int group, int mask, double friction) {
  // Of what moves without being moved, Bullet takes the velocity into account for rigid bodies
  // only.
  shape_ = std::make_unique<btBoxShape>(btVector3(half_extent, half_extent, half_depth));
  btRigidBody::btRigidBodyConstructionInfo info(0.0, nullptr, shape_.get());
  info.m_startWorldTransform.setOrigin(btVector3(0.0, 0.0, -half_depth));
  platform_ = std::make_unique<btRigidBody>(info);
  platform_->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  platform_->setActivationState(DISABLE_DEACTIVATION);
  platform_->setFriction(friction);
  world_.addRigidBody(platform_.get(), group, mask);
}

void BulletGround::make_tiles(int group, int mask, double friction) {
  constexpr double half = 0.5 * Terrain::tile_size;
  shape_ = std::make_unique<btBoxShape>(btVector3(half, half, tile_half_depth));
  const std::int64_t first = -tiles_a_side / 2;
  for (std::int64_t column = first; column < first + tiles_a_side; ++column) {
    for (std::int64_t row = first; row < first + tiles_a_side; ++row) {
      Tile& tile = tiles_.emplace_back(Tile{column, row, std::make_unique<btCollisionObject>()});
      tile.object->setCollisionShape(shape_.get());
      tile.object->setFriction(friction);
      // Nobody but put() moves it: Bullet need not look after its bounds at every step.
      tile.object->setActivationState(ISLAND_SLEEPING);
      world_.addCollisionObject(tile.object.get(), group, mask);
      put(tile, column, row);
    }
  }
  world_.setForceUpdateAllAabbs(false);
}

void BulletGround::put(Tile& tile, std::int64_t column, std::int64_t row) {
  tile.column = column;
  tile.row = row;
  const auto middle = [](std::int64_t index) {
    return static_cast<double>(index) * Terrain::tile_size;
  };
  const double top = terrain_.tile_height(column, row);
  tile.object->setWorldTransform(btTransform(
      btQuaternion::getIdentity(), btVector3(middle(column), middle(row), top - tile_half_depth)));
  world_.updateSingleAabb(tile.object.get());
}

void BulletGround::prepare(double time, const Vec2& place) {
  if (platform_) {
    const Vec2 position = terrain_.platform_position(time);
    platform_->getWorldTransform().setOrigin(btVector3(position.x(), position.y(), -half_depth));
    return;
  }
  if (tiles_.empty()) return;
  const std::int64_t column = Terrain::tile_index(place.x());
  const std::int64_t row = Terrain::tile_index(place.y());
  if (column == column_ && row == row_) return;
  column_ = column;
  row_ = row;
  for (Tile& tile : tiles_) {
    const std::int64_t new_column = wrapped(tile.column, column - tiles_a_side / 2);
    const std::int64_t new_row = wrapped(tile.row, row - tiles_a_side / 2);
    if (new_column != tile.column || new_row != tile.row) put(tile, new_column, new_row);
  }
}

}  // namespace stagger::sim

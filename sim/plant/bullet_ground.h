// The terrain as Bullet's collision objects. For bullet_world.cpp alone: it shows Bullet's headers.
#pragma once

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <memory>
#include <vector>

#include "sim/plant/terrain.h"

namespace stagger::sim {

/// Flat ground, slope and platform are one big box: Bullet's box-box test gives all corners of a
/// sole at once, where its box-plane test collects them over several ticks. Uneven ground is a
/// square of tiles around the robot that goes along with it: tiles that are left behind come up
/// again in front.
class BulletGround {
 public:
  /// `friction` is the coefficient of what stands on it; Bullet multiplies the two.
  BulletGround(const Terrain& terrain, btMultiBodyDynamicsWorld& world, int group, int mask,
               double friction);
  BulletGround(const BulletGround&) = delete;
  BulletGround& operator=(const BulletGround&) = delete;
  ~BulletGround();

  /// Before a step that ends at `time` [s], with the robot about `place` [m].
  void prepare(double time, const Vec2& place);

 private:
  struct Tile {
    std::int64_t column;
    std::int64_t row;
    std::unique_ptr<btCollisionObject> object;
  };

  void make_box(int group, int mask, double friction);
  void make_platform(int group, int mask, double friction);
  void make_tiles(int group, int mask, double friction);
  void put(Tile& tile, std::int64_t column, std::int64_t row);

  const Terrain& terrain_;
  btMultiBodyDynamicsWorld& world_;
  std::unique_ptr<btBoxShape> shape_;
  std::unique_ptr<btCollisionObject> box_;
  std::unique_ptr<btRigidBody> platform_;
  std::vector<Tile> tiles_;
  std::int64_t column_ = 0;  ///< of the tile that the robot is over
  std::int64_t row_ = 0;
};

}  // namespace stagger::sim

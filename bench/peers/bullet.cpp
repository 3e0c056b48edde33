// Bullet, z up, with its sequential impulse solver.
// Tuned: lengths x 50, so that its contact breaking threshold of 20 mm is 5 % of a thickness and its restitution threshold of 0.2 m/s does
// not matter (restitution is 0 here); friction solved along two directions, without which the front is 4 % too fast however small the step;
// 10 iterations, its default: more change the speed by 0.02 %; one step a call, no interpolation. Friction is multiplied, so bricks
// have sqrt(0.2) and the floor 0.5 / sqrt(0.2).
// Could not be matched: Debian's build is in single precision.
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <memory>
#include <vector>

#include "peer.h"

namespace {

btScalar number(double x) { return static_cast<btScalar>(x); }

class BulletWorld final : public peers::World {
 public:
  explicit BulletWorld(const peers::Scene& scene)
      : scene_(scene),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
        box_(btVector3(number(0.5 * scene.thickness), number(0.5 * scene.width), number(0.5 * scene.height))),
        plane_(btVector3(0, 0, 1), 0),
        floor_(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane_)),
        bodies_(scene.bricks.size()) {
    world_.setGravity(btVector3(0, 0, number(-scene.gravity)));
    world_.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    floor_.setFriction(number(scene.floor_friction / std::sqrt(scene.brick_friction)));
    world_.addRigidBody(&floor_);
    box_.calculateLocalInertia(1, inertia_);
  }
  ~BulletWorld() override {
    for (auto& body : bodies_) {
      if (body) world_.removeRigidBody(body.get());
    }
    world_.removeRigidBody(&floor_);
  }
  void add(std::size_t index) override {
    const peers::Brick& brick = scene_.bricks[index];
    btRigidBody::btRigidBodyConstructionInfo info(1, nullptr, &box_, inertia_);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(btVector3(number(brick.x), number(brick.y), number(brick.z + 0.5 * scene_.height)));
    info.m_startWorldTransform.setRotation(btQuaternion(btVector3(0, 0, 1), number(brick.heading)));
    info.m_friction = number(std::sqrt(scene_.brick_friction));
    bodies_[index] = std::make_unique<btRigidBody>(info);
    if (!scene_.sleeps) bodies_[index]->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_[index].get());
  }
  void remove(std::size_t index) override {
    world_.removeRigidBody(bodies_[index].get());
    bodies_[index].reset();
  }
  void turn_about_toe(std::size_t index, double speed) override {
    const double heading = scene_.bricks[index].heading;
    const btVector3 ahead(number(std::cos(heading)), number(std::sin(heading)), 0);
    const btVector3 left(number(-std::sin(heading)), number(std::cos(heading)), 0);
    bodies_[index]->setAngularVelocity(number(speed) * left);
    bodies_[index]->setLinearVelocity(number(0.5 * speed * scene_.height) * ahead +
                                      btVector3(0, 0, number(0.5 * speed * scene_.thickness)));
  }
  void step() override { world_.stepSimulation(number(scene_.time_step), 0); }
  std::array<double, 3> middle(std::size_t index) const override {
    const btVector3& place = bodies_[index]->getWorldTransform().getOrigin();
    return {static_cast<double>(place.x()), static_cast<double>(place.y()), static_cast<double>(place.z())};
  }
  double upright(std::size_t index) const override {
    return static_cast<double>(bodies_[index]->getWorldTransform().getBasis().getColumn(2).z());
  }

 private:
  const peers::Scene& scene_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  btBoxShape box_;
  btStaticPlaneShape plane_;
  btRigidBody floor_;
  btVector3 inertia_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

std::unique_ptr<peers::World> make(const peers::Scene& scene) { return std::make_unique<BulletWorld>(scene); }

}  // namespace

int main(int argc, char** argv) {
  return peers::run(argc, argv, {.name = "Bullet", .version = std::to_string(btGetVersion()), .scale = 50.0, .make = make});
}

// ODE, z up, with its iterative solver (dWorldQuickStep).
// Tuned: lengths x 20, so that its default tolerances fit; 50 iterations instead of 20; error reduction 0.2 and a constraint force mixing
// of 1e-9 (its default of 1e-5 makes contacts soft); at most 8 contacts a pair, the pyramid of friction scaled with the normal force
// (dContactApprox1). Friction is given for each pair. A sweep-and-prune space, sorted along the row.
// Could not be matched: its friction is a pyramid, not a cone.
#include <ode/ode.h>

#include <array>
#include <cmath>
#include <vector>

#include "peer.h"

namespace {

class OdeWorld final : public peers::World {
 public:
  explicit OdeWorld(const peers::Scene& scene) : scene_(scene), bodies_(scene.bricks.size()), geoms_(scene.bricks.size()) {
    dInitODE2(0);
    world_ = dWorldCreate();
    space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
    contacts_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, 0, 0, -scene.gravity);
    dWorldSetERP(world_, 0.2);
    dWorldSetCFM(world_, 1e-9);
    dWorldSetQuickStepNumIterations(world_, 50);
    floor_ = dCreatePlane(space_, 0, 0, 1, 0);
    dMassSetBox(&mass_, 1.0, scene.thickness, scene.width, scene.height);
  }
  ~OdeWorld() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    dCloseODE();
  }
  void add(std::size_t index) override {
    const peers::Brick& brick = scene_.bricks[index];
    bodies_[index] = dBodyCreate(world_);
    geoms_[index] = dCreateBox(space_, scene_.thickness, scene_.width, scene_.height);
    dBodySetMass(bodies_[index], &mass_);
    dGeomSetBody(geoms_[index], bodies_[index]);
    dBodySetPosition(bodies_[index], brick.x, brick.y, brick.z + 0.5 * scene_.height);
    dQuaternion turn;
    dQFromAxisAndAngle(turn, 0, 0, 1, brick.heading);
    dBodySetQuaternion(bodies_[index], turn);
  }
  void remove(std::size_t index) override {
    dGeomDestroy(geoms_[index]);
    dBodyDestroy(bodies_[index]);
  }
  void turn_about_toe(std::size_t index, double speed) override {
    const double c = std::cos(scene_.bricks[index].heading);
    const double s = std::sin(scene_.bricks[index].heading);
    const double ahead = 0.5 * speed * scene_.height;
    dBodySetAngularVel(bodies_[index], -speed * s, speed * c, 0);
    dBodySetLinearVel(bodies_[index], ahead * c, ahead * s, 0.5 * speed * scene_.thickness);
  }
  void step() override {
    dSpaceCollide(space_, this, &OdeWorld::meet);
    dWorldQuickStep(world_, scene_.time_step);
    dJointGroupEmpty(contacts_);
  }
  std::array<double, 3> middle(std::size_t index) const override {
    const dReal* place = dBodyGetPosition(bodies_[index]);
    return {place[0], place[1], place[2]};
  }
  double upright(std::size_t index) const override { return dBodyGetRotation(bodies_[index])[10]; }

 private:
  static void meet(void* self, dGeomID a, dGeomID b) {
    auto& world = *static_cast<OdeWorld*>(self);
    std::array<dContact, 8> contacts;
    const int count = dCollide(a, b, static_cast<int>(contacts.size()), &contacts[0].geom, sizeof(dContact));
    const bool on_floor = a == world.floor_ || b == world.floor_;
    for (int i = 0; i < count; ++i) {
      dContact& contact = contacts[static_cast<std::size_t>(i)];
      contact.surface.mode = dContactApprox1;
      contact.surface.mu = on_floor ? world.scene_.floor_friction : world.scene_.brick_friction;
      dJointAttach(dJointCreateContact(world.world_, world.contacts_, &contact), dGeomGetBody(a), dGeomGetBody(b));
    }
  }

  const peers::Scene& scene_;
  dWorldID world_ = nullptr;
  dSpaceID space_ = nullptr;
  dJointGroupID contacts_ = nullptr;
  dGeomID floor_ = nullptr;
  dMass mass_;
  std::vector<dBodyID> bodies_;
  std::vector<dGeomID> geoms_;
};

std::unique_ptr<peers::World> make(const peers::Scene& scene) { return std::make_unique<OdeWorld>(scene); }

}  // namespace

int main(int argc, char** argv) { return peers::run(argc, argv, {.name = "ODE", .version = "0.16", .scale = 20.0, .make = make}); }

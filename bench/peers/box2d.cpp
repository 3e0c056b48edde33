// Box2D 2.4, in the plane of a straight row: x ahead, y up.
// Tuned: lengths x 100, so that its slop of 5 mm and its polygon skin of 10 mm are under 2 % of a thickness, and its threshold of 1 m/s for
// restitution does not matter (restitution is 0 here). Iterations 8 and 3, as its manual advises; continuous collision is on, sleep is
// allowed. Friction is mixed as the root of a product, so the floor's 1.25 with a brick's 0.2 gives 0.5. Could not be matched: a third
// dimension, so curves are left out; numbers are single precision, and rows longer than some kilometres of true length lose accuracy for
// that.
#include <box2d/box2d.h>

#include <vector>

#include "peer.h"

namespace {

class Box2DWorld final : public peers::World {
 public:
  explicit Box2DWorld(const peers::Scene& scene)
      : scene_(scene), world_(b2Vec2(0.0F, static_cast<float>(-scene.gravity))), bodies_(scene.bricks.size()) {
    b2BodyDef ground;
    b2EdgeShape floor;
    const auto length = static_cast<float>(scene.bricks.back().x + 10.0 * scene.height);
    floor.SetTwoSided(b2Vec2(static_cast<float>(-10.0 * scene.height), 0.0F), b2Vec2(length, 0.0F));
    b2FixtureDef fixture;
    fixture.shape = &floor;
    fixture.friction = static_cast<float>(scene.floor_friction * scene.floor_friction / scene.brick_friction);
    world_.CreateBody(&ground)->CreateFixture(&fixture);
  }
  void add(std::size_t index) override {
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position.Set(static_cast<float>(scene_.bricks[index].x), static_cast<float>(0.5 * scene_.height));
    b2PolygonShape box;
    box.SetAsBox(static_cast<float>(0.5 * scene_.thickness), static_cast<float>(0.5 * scene_.height));
    b2FixtureDef fixture;
    fixture.shape = &box;
    fixture.density = 1.0F;
    fixture.friction = static_cast<float>(scene_.brick_friction);
    bodies_[index] = world_.CreateBody(&def);
    bodies_[index]->CreateFixture(&fixture);
  }
  void remove(std::size_t index) override { world_.DestroyBody(bodies_[index]); }
  void turn_about_toe(std::size_t index, double speed) override {
    bodies_[index]->SetAngularVelocity(static_cast<float>(-speed));
    bodies_[index]->SetLinearVelocity(
        b2Vec2(static_cast<float>(0.5 * speed * scene_.height), static_cast<float>(0.5 * speed * scene_.thickness)));
  }
  void step() override { world_.Step(static_cast<float>(scene_.time_step), 8, 3); }
  std::array<double, 3> middle(std::size_t index) const override {
    const b2Vec2 place = bodies_[index]->GetPosition();
    return {static_cast<double>(place.x), 0.0, static_cast<double>(place.y)};
  }
  double upright(std::size_t index) const override { return static_cast<double>(bodies_[index]->GetTransform().q.c); }

 private:
  const peers::Scene& scene_;
  b2World world_;
  std::vector<b2Body*> bodies_;
};

std::unique_ptr<peers::World> make(const peers::Scene& scene) { return std::make_unique<Box2DWorld>(scene); }

}  // namespace

int main(int argc, char** argv) {
  const std::string version =
      std::to_string(b2_version.major) + "." + std::to_string(b2_version.minor) + "." + std::to_string(b2_version.revision);
  return peers::run(argc, argv, {.name = "Box2D", .version = version, .scale = 100.0, .planar = true, .make = make});
}

#include "libdem/bed/suspension.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include "libdem/errors.hpp"
#include "libdem/scene/scene.hpp"
#include "tests/dem/case/ft4.hpp"

namespace dem {
namespace {

// The vessel of the quick case: a blade that stands inside the bed.
Case quick() {
  Case c = ft4('a');
  c.blade.start_height = 2e-3;
  c.bed.depth = 5e-3;
  c.duration = 0.02;
  return c;
}

TEST(Suspension, GrainsTouchNeitherEachOtherNorAWall) {
  const Case c = quick();
  const Scene r = make_scene(c);
  const Particles p = random_suspension(r.setup, c.bed, 0, CylinderRegion{12.5e-3}, 4000, {});
  ASSERT_EQ(p.size(), 4000u);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GT((p.position[i] - p.position[j]).norm(), p.radius[i] + p.radius[j]);
    for (const Wall& w : r.setup.walls) {
      const WallPose pose = pose_at(w.motion, 0);
      std::vector<std::uint32_t> parts;
      std::vector<WallTouch> touches;
      std::vector<MeshTouch> scratch;
      candidate_parts(w, pose, p.position[i], p.radius[i], parts);
      nearest(w, pose, p.position[i], p.radius[i], parts, touches, scratch);
      for (const WallTouch& t : touches) EXPECT_GE(t.distance, p.radius[i] * (1 - 1e-12)) << w.name;
      EXPECT_FALSE(inside_material(w, pose, p.position[i])) << w.name;
    }
  }
}

TEST(Suspension, IsRandomAndNotALattice) {
  const Case c = ft4('a');
  const Particles p = random_suspension({}, c.bed, 0, BoxRegion{0, 20e-3, 0, 20e-3}, 6000, {});
  // Heights away from floor and top, modulo one diameter, are uniform: no layers. Of 3,000 and more grains in ten classes the
  // chi-square with nine degrees of freedom is below 33.7 with a probability of 0.9999.
  double top = 0;
  for (const Vec3& x : p.position) top = std::max(top, x.z());
  std::vector<double> count(10, 0.0);
  double all = 0;
  const double d = c.bed.mean_diameter, low = 4 * d, periods = std::floor((top - 8 * d) / d);
  for (const Vec3& x : p.position) {
    const double z = (x.z() - low) / d;
    if (z < 0 || z >= periods) continue;
    ++count[std::size_t(10 * (z - std::floor(z)))];
    ++all;
  }
  ASSERT_GT(all, 2000);
  double chi_square = 0;
  for (const double n : count) chi_square += (n - all / 10) * (n - all / 10) / (all / 10);
  EXPECT_LT(chi_square, 33.7);
}

TEST(Suspension, IsTheSameForAnyNumberOfThreads) {
  const Case c = quick();
  omp_set_num_threads(1);
  const Particles one = random_suspension({}, c.bed, 0, CylinderRegion{6e-3}, 1000, {});
  omp_set_num_threads(2);
  const Particles two = random_suspension({}, c.bed, 0, CylinderRegion{6e-3}, 1000, {});
  omp_set_num_threads(1);
  EXPECT_EQ(one.position, two.position);
  EXPECT_EQ(one.radius, two.radius);
}

TEST(Suspension, SaysWhereGrainsDoNotFit) {
  const Case c = quick();
  EXPECT_THROW(random_suspension({}, c.bed, 0, CylinderRegion{0.5e-3}, 10, {}), CaseError);
  EXPECT_THROW(random_suspension({}, c.bed, 0, BoxRegion{0, 1, 0, 1e-3}, 10, {}), CaseError);
  dem::Setup narrow;  // the walls leave less than the region promises
  narrow.walls = {Wall{"pipe", 0, Cylinder{Vec3::Zero(), Vec3::UnitZ(), 0.3e-3}, {}}};
  EXPECT_THROW(random_suspension(narrow, c.bed, 0, CylinderRegion{6e-3}, 10, {}), CaseError);
}

}  // namespace
}  // namespace dem

#include "sim/robot/mesh_file.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cmath>

#include "found_biped.h"

namespace stagger::sim {
namespace {

using engine::Vec3;

TEST(MeshFile, PackagesAreFoundByNameInTheFolderAndAbove) {
  const TestFolder folder;
  std::filesystem::create_directories(folder.path() / "my_robot/meshes");
  std::filesystem::create_directories(folder.path() / "my_robot/urdf");
  folder.write("my_robot/meshes/foot.stl", "x");
  const std::filesystem::path urdf = folder.path() / "my_robot/urdf";
  for (const char* uri :
       {"package://my_robot/meshes/foot.stl", "../meshes/foot.stl", "meshes/foot.stl"}) {
    const auto found = find_mesh(uri, urdf);
    ASSERT_TRUE(found) << uri;
    EXPECT_TRUE(std::filesystem::equivalent(*found, folder.path() / "my_robot/meshes/foot.stl"));
  }
  EXPECT_TRUE(find_mesh("file://" + (folder.path() / "my_robot/meshes/foot.stl").string(), urdf));
  EXPECT_FALSE(find_mesh("package://other/meshes/foot.stl", urdf));
  EXPECT_FALSE(find_mesh("package://", urdf));
  EXPECT_FALSE(find_mesh("", urdf));
}

TEST(MeshFile, CopiesStayBelowTheirFolder) {
  EXPECT_EQ(mesh_place("package://a/b/c.stl"), "a/b/c.stl");
  EXPECT_EQ(mesh_place("../../b/c.stl"), "b/c.stl");
  EXPECT_EQ(mesh_place("package://../../etc/c.stl"), "etc/c.stl");
  EXPECT_EQ(mesh_place("file:///somewhere/c.stl"), "meshes/c.stl");
}

TEST(MeshFile, ReadsStlAndObj) {
  const auto stl = read_mesh("tests/data/robots/small_feet/meshes/foot.stl");
  Vec3 low = stl[0];
  Vec3 high = stl[0];
  for (const Vec3& p : stl) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  EXPECT_LT((low - Vec3(-120.0, -60.0, 0.0)).norm(), 1e-4);
  EXPECT_LT((high - Vec3(120.0, 60.0, 40.0)).norm(), 1e-4);
  const TestFolder folder;
  EXPECT_EQ(read_mesh(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n")).size(), 3U);
}

TEST(MeshFile, AStrangersMeshIsLookedForInItsFolderAlone) {
  const TestFolder folder;
  std::filesystem::create_directories(folder.path() / "robot/a/meshes");
  folder.write("outside.stl", "x");
  folder.write("robot/a/meshes/foot.stl", "x");
  std::filesystem::create_symlink(folder.path() / "outside.stl", folder.path() / "robot/link.stl");
  const std::filesystem::path robot = folder.path() / "robot";
  EXPECT_TRUE(find_mesh("package://a/meshes/foot.stl", robot, Trust::stranger));
  EXPECT_TRUE(find_mesh("../a/meshes/foot.stl", robot, Trust::stranger));
  for (const std::string& uri :
       {std::string("../outside.stl"), (folder.path() / "outside.stl").string(),
        "file://" + (folder.path() / "outside.stl").string(), std::string("link.stl")}) {
    EXPECT_TRUE(find_mesh(uri, robot)) << uri;
    EXPECT_FALSE(find_mesh(uri, robot, Trust::stranger)) << uri;
  }
  EXPECT_EQ(trust_in(robot), Trust::own);
  folder.write("robot/.stranger", "");
  EXPECT_EQ(trust_in(robot), Trust::stranger);
}

TEST(MeshFile, AStrangersMeshOpensNoOtherFile) {
  const TestFolder folder;
  // The file names another one; a pipe without a writer would be waited for without end.
  ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  const auto obj = folder.write("a.obj", "mtllib pipe\nv 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  EXPECT_EQ(read_mesh(obj, Trust::stranger).size(), 3U);
  EXPECT_THROW(read_mesh(folder.write("a.ply", "ply\n"), Trust::stranger), std::runtime_error);
}

TEST(MeshFile, AStrangersMeshHasALimitOfVertices) {
  const TestFolder folder;
  std::string text;
  for (int i = 0; i < 170000; ++i) text += "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -3\n";
  const auto file = folder.write("many.obj", text);
  EXPECT_THROW(read_mesh(file, Trust::stranger), std::runtime_error);
  EXPECT_EQ(read_mesh(file).size(), 510000U);
}

TEST(MeshFile, WhatIsNoMeshIsAnError) {
  const TestFolder folder;
  for (const char* text : {"", "solid a\nendsolid a\n", "what is this?"}) {
    for (const char* name : {"a.stl", "a.obj", "a.dae", "a.xyz"}) {
      EXPECT_THROW(read_mesh(folder.write(name, text)), std::runtime_error) << name << text;
    }
  }
}

TEST(MeshFile, KeepsTheCornersOfASoleAmongFewPoints) {
  std::vector<Vec3> points;
  for (const double x : {-0.1, 0.1}) {
    for (const double y : {-0.05, 0.05}) points.emplace_back(x, y, 0.0);
  }
  for (int i = 0; i < 5000; ++i) {  // a dome above it
    const double angle = 0.7 * i;
    const double height = 0.08 * i / 5000.0;
    const double radius = 0.045 * std::sqrt(1.0 - i / 5000.0);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
  }
  const auto hull = hull_points(points, Vec3::UnitZ());
  EXPECT_LE(hull.size(), max_hull_points);
  for (int i = 0; i < 4; ++i) EXPECT_THAT(hull, ::testing::Contains(points[i]));
  EXPECT_EQ(hull, hull_points(points, Vec3::UnitZ()));
}

}  // namespace
}  // namespace stagger::sim

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.hpp"

namespace stylet {
namespace {

const Vec4 kInside(0.1, 0.2, 0.3, 0.4);

Tissue body(Element element) {
  TetMesh mesh = box_mesh({-20, 10, 30}, {20, 50, 90}, {2, 3, 2}, 0.15);
  const auto fixed = test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 30.0; });
  return test::build(std::move(mesh), {{0.02, 0.45}}, fixed, element);
}

using Shapes = test::ElementTest;
STYLET_FOR_EVERY_ELEMENT(Shapes);

TEST_P(Shapes, interpolates_linear_fields_and_their_gradients_exactly) {
  const Tissue tissue = body(GetParam());
  Mat3 gradient;
  gradient << 0.1, -0.2, 0.3, 0.05, 0.4, -0.1, 0.2, 0.15, -0.3;
  const auto field = [&](const Vec3& x) { return Vec3(gradient * x + Vec3(1, 2, 3)); };
  for (Index t = 0; t < tissue.mesh().tet_count(); ++t) {
    Vec3 x = Vec3::Zero();
    for (int i = 0; i < 4; ++i) x += kInside[i] * tissue.mesh().nodes[tissue.mesh().tets[t][i]];
    const Shape shape = tissue.shape(t, kInside);
    Vec3 u = Vec3::Zero();
    for (int i = 0; i < shape.count; ++i) u += shape.weight[i] * field(tissue.node_position(shape.node[i]));
    EXPECT_LT((u - field(x)).norm(), 1e-13 * field(x).norm());

    const ShapeGradients gradients = tissue.shape_gradients(t, kInside);
    Mat3 computed = Mat3::Zero();
    for (int i = 0; i < gradients.count; ++i) {
      computed += field(tissue.node_position(gradients.node[i])) * gradients.gradient.col(i).transpose();
    }
    EXPECT_LT((computed - gradient).norm(), 1e-12 * gradient.norm());
  }
}

TEST_P(Shapes, is_one_at_its_own_node_and_names_the_elements_nodes) {
  const Tissue tissue = body(GetParam());
  const auto nodes = tissue.nodes_of(5);
  for (int corner = 0; corner < 4; ++corner) {
    const Shape shape = tissue.shape(5, Vec4::Unit(corner));
    ASSERT_EQ(shape.count, static_cast<int>(nodes.size()));
    for (int i = 0; i < shape.count; ++i) {
      EXPECT_EQ(shape.node[i], nodes[i]);
      EXPECT_EQ(shape.weight[i], i == corner ? 1.0 : 0.0);
    }
  }
}

}  // namespace
}  // namespace stylet

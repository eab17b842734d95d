// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/moment.hpp"

namespace stylet {

Moment moment_at_rest(const TetMesh& mesh) {
  Moment moment;
  moment.displacement = Eigen::Matrix3Xf::Zero(3, mesh.node_count());
  return moment;
}

}  // namespace stylet

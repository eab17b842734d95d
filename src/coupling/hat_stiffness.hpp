// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

namespace stylet {

// Terms of the elastic energy's bilinear form a(·,·) with the hat b_p of an added node p, in one element that the node
// splits, for three directions at once (docs/theory/coupling.md §2b).

/// k_pp = a(b_p, b_p) [N/mm]: V Σ_q (1/l_q) [(λ + μ) g_q g_qᵀ + μ |g_q|² I].
/// @param gradients g of the element's barycentric coordinates [1/mm] @param volume V [mm³]
/// @param weights l of the node in the element; a vertex with weight 0, opposite the node's face, has no term
Mat3 hat_stiffness(const Eigen::Matrix<double, 3, 4>& gradients, double volume, const Material& material,
                   const Vec4& weights);

/// k_jp = a(φ_j, b_p) [N/mm] for the element's vertices j, for a node on the face opposite vertex `opposite`. For a
/// node inside an element they are all zero.
std::array<Mat3, 4> hat_border(const Eigen::Matrix<double, 3, 4>& gradients, double volume, const Material& material,
                               int opposite);

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

namespace stylet {

// What an element that an added node p splits has of the elastic energy's bilinear form a(·,·) with the node's hat b_p,
// in three directions at once (docs/theory/coupling.md 2b).

/// k_pp = a(b_p, b_p) [N/mm]: V Σ_q (1/l_q) [(λ + μ) g_q g_qᵀ + μ |g_q|² I].
/// @param gradients g of the element's barycentric coordinates [1/mm], @param volume V [mm³]
/// @param weights l of the node in the element; one of a node on the face opposite is 0, and has no part
Mat3 hat_stiffness(const Eigen::Matrix<double, 3, 4>& gradients, double volume, const Material& material,
                   const Vec4& weights);

/// k_jp = a(φ_j, b_p) [N/mm] for the element's vertices j, of a node on the face opposite vertex `opposite`. They are
/// all zero of a node inside.
std::array<Mat3, 4> hat_border(const Eigen::Matrix<double, 3, 4>& gradients, double volume, const Material& material,
                               int opposite);

}  // namespace stylet

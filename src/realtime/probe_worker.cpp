// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/probe_worker.hpp"

#include "stylet/core/survive.hpp"
#include "thread_setup.hpp"

#include <chrono>
#include <stdexcept>
#include <string>

namespace stylet {

namespace {

constexpr auto kLookForPose = std::chrono::milliseconds(1);

}  // namespace

ProbeWorker::ProbeWorker(ProbeContact contact, std::vector<Index> nodes)
    : contact_(std::move(contact)),
      nodes_(std::move(nodes)),
      nodes_count_(nodes_.empty() ? contact_.wall().nodes.rows() / 3 : static_cast<Eigen::Index>(nodes_.size())) {
  for (const Index node : nodes_) {
    if (node < 0 || 3 * Eigen::Index{node} >= contact_.wall().nodes.rows())
      throw std::out_of_range("ProbeWorker: node " + std::to_string(node) + " is not in the mesh");
  }
  for (Eigen::Matrix3Xf& field : fields_) field = Eigen::Matrix3Xf::Zero(3, nodes_count_);
  thread_ = std::thread([this] { run(); });
}

ProbeWorker::~ProbeWorker() {
  stop_.store(true, std::memory_order_relaxed);
  thread_.join();
}

std::uint32_t ProbeWorker::move(const Capsule& probe) {
  pose_.write({++number_, probe});
  return number_;
}

void ProbeWorker::answer_pose(const Pose& pose) {
  Answer& answer = answer_.draft();
  // Each of the three slots keeps the field that it gets at its first use.
  if (answer.displacement == nullptr) answer.displacement = fields_[given_++].data();
  Eigen::Matrix3Xf* field = nullptr;
  for (Eigen::Matrix3Xf& candidate : fields_)
    if (candidate.data() == answer.displacement) field = &candidate;
  answer.pose = pose.number;
  answer.probe = pose.probe;
  answer.press = contact_.press(pose.probe);
  if (nodes_.empty()) {
    contact_.displacement(*field);
  } else {
    contact_.displacement(nodes_, *field);
  }
  answer_.publish();
}

void ProbeWorker::run() noexcept {
  yield_to_others();
  while (!stop_.load(std::memory_order_relaxed)) {
    if (pose_.fetch()) {
      survive(
          "the press of the probe", [this] { answer_pose(pose_.value()); }, [](const Error&) {});
    } else {
      std::this_thread::sleep_for(kLookForPose);
    }
  }
}

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "field_maker.hpp"
#include "image_desk.hpp"
#include "implant_desk.hpp"
#include "interrupted_implant.hpp"
#include "leaving.hpp"
#include "map_maker.hpp"
#include "room.hpp"
#include "scene.hpp"

namespace stylet::serve {

/// The case that is open: its scenario, patient and model, the map of its template, its plan of seeds, and the needle
/// that is or was in front of the patient last. It outlasts a replay. Requests: Desk::open_case.
class OpenCase {
 public:
  explicit OpenCase(const SessionSettings& settings) : settings_(settings) {}

  /// Names a model to open or a needle to go live, or refuses to.
  Reply ask(const Request& request);
  /// Opens a model and names the needle to go live. Errors: those of loading it; the open model then stays.
  Result<Reply> open(const ToOpen& what, const Progress& progress);
  /// The needle that was there last, with its scene; without an open model, the case to open.
  Reply last_needle(const Request& request);
  /// The scene of the open model.
  [[nodiscard]] Message scene();
  /// The map if the viewers are to get another one. During a replay they get an empty map, because a replay shows
  /// another needle, perhaps in another patient.
  std::optional<Message> map_news(bool is_replaying);
  /// Whether the work on the displacement field has ended since the last call.
  bool take_field();

  [[nodiscard]] bool is_open() const { return open_.model != nullptr; }
  [[nodiscard]] const OpenModel& model() const { return open_; }
  [[nodiscard]] CaseList list() const;
  /// The patient for pictures; there must be an open model.
  [[nodiscard]] ImageSubject patient() const;
  /// Which part of the picture is missing, and which implant can be gone on with.
  void describe(SessionStatus& status) const;

 private:
  Reply choose_hole(const Request& request);
  Reply choose_plan(const Request& request, const InsertionPlan& plan, const std::string& where);
  Reply choose_needle(std::size_t which);
  Reply answer_offer(const Request& request);
  [[nodiscard]] const InterruptedImplant* offer() const;
  [[nodiscard]] ToOpen other_needle(const InsertionPlan& plan, const std::string& where) const;
  void begin_case(std::shared_ptr<ImplantDesk> implant, Reply& reply);
  void begin_map();
  void keep_needle();
  void log(const Model& model, const char* part, double seconds) const;
  void show_scene(std::size_t way, Reply& reply);
  Reply put(std::size_t which, Reply reply = {});

  const SessionSettings& settings_;
  std::size_t number_ = 0;  ///< of the open case
  OpenModel open_;          ///< has no model if none could be opened
  /// The plan of the case; the open model may have an insertion through another hole.
  Scenario scenario_;
  std::vector<PlannedInsertion> insertions_;
  std::size_t insertion_ = 0;                ///< of the open model
  std::shared_ptr<ImplantDesk> implant_;     ///< null: the case has no plan of seeds
  std::shared_ptr<ImplantSearch> search_;    ///< for an implant to go on with; null: none is wanted
  std::shared_ptr<FieldMaker> field_maker_;  ///< until the field of the open model is complete
  std::string no_field_;                     ///< why the open model has none
  std::shared_ptr<MapMaker> map_maker_;
  LiveMap map_;                  ///< the latest one
  bool map_is_shown_ = false;    ///< the viewers have it
  bool page_has_drawn_ = false;  ///< some page has drawn its first picture; then a FieldMaker does not wait
  Leaving leaving_;              ///< workers for earlier models and cases
};

}  // namespace stylet::serve

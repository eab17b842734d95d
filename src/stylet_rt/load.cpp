// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary.hpp"
#include "handles.hpp"
#include "stylet/io/model_file.hpp"

#include <string>
#include <vector>

extern "C" stylet_rt_status stylet_rt_model_load(const char* path, const char* const* settings, size_t settings_count,
                                                 stylet_rt_model** model, char* error, size_t error_size) noexcept {
  stylet::rt::ErrorText text(error, error_size);
  if (model == nullptr) return text.bad_argument("stylet_rt_model_load: the argument model is null");
  *model = nullptr;
  if (path == nullptr) return text.bad_argument("stylet_rt_model_load: the argument path is null");
  if (settings == nullptr && settings_count > 0)
    return text.bad_argument("stylet_rt_model_load: the argument settings is null, but settings_count is not 0");
  return stylet::rt::guarded(text, [&]() -> stylet_rt_status {
    std::vector<std::string> all;
    for (size_t k = 0; k < settings_count; ++k) {
      if (settings[k] == nullptr) return text.bad_argument("stylet_rt_model_load: one of the settings is null");
      all.emplace_back(settings[k]);
    }
    const auto loaded = stylet::load_model(path, {}, all);
    if (!loaded) return text.of(loaded.error());
    if (!(*loaded)->staying().empty()) {
      return text.of(stylet::input_error(
          path, "the model has needles in place (procedure.stabilising), and the loop holds one needle only",
          "Prepare the model with --set procedure.stabilising=[]"));
    }
    *model = stylet::rt::make_handle(*loaded);
    return STYLET_RT_OK;
  });
}

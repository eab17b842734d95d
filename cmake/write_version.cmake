# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the C++ file with the version of the sources: "0.2.0" of a source archive, "0.2.0+1a2b3c4d" of a clone at that
# commit, and "0.2.0+1a2b3c4d.modified" where files differ from it. The file is left alone while its text is the same.
# Called at each build with -DVERSION= -DSOURCE= -DTEMPLATE= -DOUTPUT=
set(STYLET_VERSION ${VERSION})
if(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git -C ${SOURCE} rev-parse --short=8 HEAD
                  OUTPUT_VARIABLE commit RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT failed)
    string(APPEND STYLET_VERSION +${commit})
    execute_process(COMMAND git --no-optional-locks -C ${SOURCE} status --porcelain --untracked-files=no
                    OUTPUT_VARIABLE modified ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(modified)
      string(APPEND STYLET_VERSION .modified)
    endif()
  endif()
endif()
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)

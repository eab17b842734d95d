# SPDX-License-Identifier: GPL-3.0-or-later
# Copies the sources of the pages to the build folder, where nothing else of theirs is left.
# Called with -DSOURCE= -DBUILD=
file(REMOVE_RECURSE ${BUILD}/report ${BUILD}/live ${BUILD}/shared)
file(COPY ${SOURCE}/report ${SOURCE}/live ${SOURCE}/shared ${SOURCE}/tsconfig.json ${SOURCE}/vite.config.ts DESTINATION ${BUILD})
file(TOUCH ${BUILD}/sources.stamp)

# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

if (UNIX AND NOT APPLE)
  find_program(ES_XVFB_RUN xvfb-run DOC "Runs what draws on a virtual display (empty: on your own)")
endif ()

# What draws runs on a virtual display where there is one: no window pops up, and every machine draws with
# the same renderer. Without any display it is left out, for this reason.
set(es_no_display)
if (UNIX AND NOT APPLE AND NOT ES_XVFB_RUN AND "$ENV{DISPLAY}" STREQUAL "")
  set(es_no_display "there is no display, and xvfb-run was not found (Debian, Ubuntu: packages xvfb and xauth)")
endif ()

# es_display_prefix(<variable>): the words to put before a command that draws. Each call
# gives another display number, and each build folder begins with another: those started at the same
# moment would take the same display. (Without -noreset the server ends with its first client, which
# now and then is too early.)
function (es_display_prefix variable)
  set(prefix)
  if (ES_XVFB_RUN)
    get_property(number GLOBAL PROPERTY es_display_number)
    if (NOT number)
      string(MD5 hash "${CMAKE_BINARY_DIR}")
      string(SUBSTRING "${hash}" 0 6 hash)
      math(EXPR number "100 + 0x${hash} % 997")
    endif ()
    set(prefix "${ES_XVFB_RUN}" -a -n "${number}" -s "-screen 0 1280x1024x24 -noreset")
    math(EXPR number "${number} + 10")
    set_property(GLOBAL PROPERTY es_display_number "${number}")
  endif ()
  set("${variable}" ${prefix} PARENT_SCOPE)
endfunction ()

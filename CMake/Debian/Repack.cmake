# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# Run by cpack when its packages are made. Each is unpacked and packed again by dpkg-deb: without
# the scripts that cpack writes to call ldconfig, for which the package has a trigger; and with the
# date of SOURCE_DATE_EPOCH for all files, so that two builds of the same sources are the same bytes.
string(TIMESTAMP epoch "%s" UTC) # of SOURCE_DATE_EPOCH, if set

function (step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_QUIET)
  if (failed)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "This failed (${failed}): ${command}")
  endif ()
endfunction ()

foreach (package IN LISTS CPACK_PACKAGE_FILES)
  set(folder "${package}.folder")
  file(REMOVE_RECURSE "${folder}")
  step(dpkg-deb --raw-extract "${package}" "${folder}")
  foreach (script IN ITEMS postinst postrm)
    if (EXISTS "${folder}/DEBIAN/${script}")
      file(READ "${folder}/DEBIAN/${script}" text)
      if (text MATCHES "ldconfig")
        file(REMOVE "${folder}/DEBIAN/${script}")
      endif ()
    endif ()
  endforeach ()
  step(find "${folder}" -exec touch --no-dereference "--date=@${epoch}" {} +)
  step("${CMAKE_COMMAND}" -E env "SOURCE_DATE_EPOCH=${epoch}"
    dpkg-deb --root-owner-group --build "${folder}" "${package}")
  file(REMOVE_RECURSE "${folder}")
endforeach ()

# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's ranks exchange as those of python3 do, and make the same of spread points: the tests of
Testing/Python with the package that the plugin brings. Run by mpirun with pvbatch --symmetric.
"""
from plugin_testing import start
from on_ranks import end

start()
import TestExchanges  # noqa: E402  (the plugin brings the package)
import TestSpreadChain  # noqa: E402

end("; ".join(test.main() for test in (TestExchanges, TestSpreadChain)))

# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""All tests of exchanges and filters on several ranks, in one start of them: run by mpirun. Each runs alone, too."""

import on_ranks
import TestExchanges
import TestManyRanks
import TestManyRanksConstraints
import TestManyRanksFill
import TestManyRanksPieces
import TestManyRanksTrim

OPTIONS = on_ranks.options_of()
TESTS = TestManyRanks, TestManyRanksConstraints, TestManyRanksFill, TestManyRanksPieces, TestManyRanksTrim
on_ranks.end("; ".join([TestExchanges.main(), *(test.main(OPTIONS) for test in TESTS)]))

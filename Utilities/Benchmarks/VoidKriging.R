# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Fills voids for void-bench by ordinary kriging with R's gstat; VoidPeers.py says how both speak.
#
# Of each void, the variogram is that of up to 1,500 nodes around it, with the model among
# exponential, spherical and Matern ones that gstat fits best. All lost nodes are predicted from the
# same nodes: up to 300 of the three rows next to the void, and up to 100 of the rest.
suppressPackageStartupMessages({
  library(sp)
  library(gstat)
})

STANDARD_ERRORS <- 2

thinned <- function(ids, most) ids[unique(round(seq(1, length(ids), length.out = min(most, length(ids)))))]

grown <- function(mask) {
  rows <- nrow(mask)
  columns <- ncol(mask)
  for (turn in 1:2) {
    more <- mask
    if (rows > 1) {
      more[-1, ] <- more[-1, ] | mask[-rows, ]
      more[-rows, ] <- more[-rows, ] | mask[-1, ]
    }
    mask <- t(more)
    swap <- rows
    rows <- columns
    columns <- swap
  }
  mask
}

fitted_model <- function(data, width) {
  sampled <- variogram(z ~ 1, data, cutoff = width, width = width / 15)
  models <- list(vgm(c("Exp", "Sph")), vgm("Mat", kappa = 1), vgm("Mat", kappa = 2))
  best <- NULL
  least <- Inf
  for (model in models) {
    fit <- tryCatch(suppressWarnings(fit.variogram(sampled, model)), error = function(e) NULL)
    if (!is.null(fit) && all(is.finite(fit$psill)) && all(fit$psill >= 0) && all(fit$range >= 0) &&
        sum(fit$psill) > 0 && attr(fit, "SSErr") < least) {
      best <- fit
      least <- attr(fit, "SSErr")
    }
  }
  if (is.null(best)) vgm(max(sampled$gamma), "Exp", width / 3) else best
}

fill <- function(source, target) {
  values <- readBin(source, "double", n = file.size(source) / 8, endian = "little")
  width <- values[1]
  height <- values[2]
  count <- width * height
  heights <- values[4 + seq_len(count)]
  lost <- matrix(values[4 + count + seq_len(count)] > 0, width)
  began <- proc.time()
  known <- !is.na(heights)
  near <- lost
  for (row in 1:3) near <- grown(near)
  ring <- which(near & known)
  rest <- which(!near & known)
  x <- (seq_len(count) - 1) %% width * values[3]
  y <- (seq_len(count) - 1) %/% width * values[4]
  table <- function(ids) {
    data <- data.frame(x = x[ids], y = y[ids], z = heights[ids])
    coordinates(data) <- ~ x + y
    data
  }
  wide <- 0.5 * max(diff(range(x)), diff(range(y)))
  model <- fitted_model(table(thinned(c(ring, rest), 1500)), wide)
  data <- table(c(thinned(ring, 300), if (length(rest)) thinned(rest, 100)))
  places <- data.frame(x = x[lost], y = y[lost])
  coordinates(places) <- ~ x + y
  result <- krige(z ~ 1, data, places, model, debug.level = 0)
  seconds <- sum((proc.time() - began)[c(1, 2)])
  filled <- rep(NaN, count)
  low <- filled
  high <- filled
  away <- STANDARD_ERRORS * sqrt(pmax(0, result$var1.var))
  filled[lost] <- result$var1.pred
  low[lost] <- result$var1.pred - away
  high[lost] <- result$var1.pred + away
  rasters <- c(filled, low, high)
  rasters[is.na(rasters)] <- NaN
  writeBin(rasters, target, endian = "little")
  seconds
}

input <- file("stdin", "r")
cat("ready\n")
flush(stdout())
while (length(line <- readLines(input, 1)) > 0) {
  paths <- strsplit(line, "\t")[[1]]
  answer <- tryCatch(sprintf("done %.6f", fill(paths[1], paths[2])),
    error = function(e) paste("failed", gsub("\\s+", " ", conditionMessage(e))))
  cat(answer, "\n", sep = "")
  flush(stdout())
}

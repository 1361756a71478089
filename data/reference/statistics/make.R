# Makes the reference values in this folder:   Rscript make.R
# (apt-get install r-base-core r-cran-survival r-cran-powerlaw; made with R 4.2.2, survival 3.5-3, poweRlaw 0.70.6)
suppressPackageStartupMessages({library(survival); library(poweRlaw)})
set.seed(20261128)
out <- function(x, file) write.csv(format(x, digits = 15, trim = TRUE, drop0trailing = TRUE), file, row.names = FALSE, quote = FALSE)

# Lifetimes: exponential and Weibull ones, some cut off on the right, some seen only from an age on, with ties in the third case.
lifetimes <- function(case, group, n, draw, cut, truncated = FALSE, digits = 15) {
  time <- signif(draw(n), digits); end <- signif(cut(n), digits)
  entry <- if (truncated) signif(pmin(time, end) * runif(n, 0, 0.9) * (runif(n) < 0.4), digits) else rep(0, n)
  data.frame(case = case, group = group, entry = entry, time = pmin(time, end), ended = as.integer(time <= end))
}
never <- function(n) rep(1e9, n)
data <- rbind(
  lifetimes("whole", 1, 60, function(n) rexp(n, 100), never),
  lifetimes("censored", 1, 80, function(n) rexp(n, 100), function(n) rexp(n, 50)),
  lifetimes("ties", 1, 90, function(n) ceiling(rexp(n, 0.2)), function(n) ceiling(runif(n, 0, 15)), digits = 3),
  lifetimes("truncated", 1, 70, function(n) rweibull(n, 0.7, 0.01), function(n) rexp(n, 30), truncated = TRUE),
  lifetimes("two", 1, 50, function(n) rexp(n, 100), function(n) rexp(n, 40)),
  lifetimes("two", 2, 60, function(n) rexp(n, 60), function(n) rexp(n, 40)),
  lifetimes("three", 1, 30, function(n) ceiling(rexp(n, 0.2)), never, digits = 3),
  lifetimes("three", 2, 40, function(n) ceiling(rexp(n, 0.2)), function(n) ceiling(runif(n, 0, 15)), digits = 3),
  lifetimes("three", 3, 20, function(n) ceiling(rexp(n, 0.1)), never, digits = 3))
out(data, "lifetimes.csv")

km <- data.frame(); medians <- data.frame()
for (case in c("whole", "censored", "ties", "truncated")) {
  d <- data[data$case == case, ]
  f <- survfit(Surv(entry, time, ended) ~ 1, data = d, conf.type = "log-log", conf.int = 0.95)
  at <- f$n.event > 0
  km <- rbind(km, data.frame(case = case, time = f$time[at], at_risk = f$n.risk[at], ended = f$n.event[at], share = f$surv[at],
                             low = f$lower[at], high = f$upper[at]))
  q <- quantile(f, 0.5)
  medians <- rbind(medians, data.frame(case = case, value = q$quantile, low = q$lower, high = q$upper))
}
out(km, "kaplan_meier.csv"); out(medians, "medians.csv")

tests <- data.frame()
for (case in c("two", "three")) {
  d <- data[data$case == case, ]
  s <- survdiff(Surv(time, ended) ~ group, data = d)
  tests <- rbind(tests, data.frame(case = case, statistic = s$chisq, degrees = length(s$n) - 1, p = pchisq(s$chisq, length(s$n) - 1, lower.tail = FALSE)))
}
out(tests, "log_rank.csv")

# Brackets: exponential durations sampled 2 apart, some cut off, some exact.
brackets <- data.frame(); shares <- data.frame()
for (case in 1:3) {
  d <- rexp(80, c(0.3, 0.1, 0.5)[case]); phase <- runif(80)
  low <- pmax(0, (floor(d / 2 + phase) - 1) * 2); high <- low + 4
  if (case > 1) high[runif(80) < 0.2] <- Inf
  if (case > 2) { exact <- runif(80) < 0.3; low[exact] <- d[exact]; high[exact] <- d[exact] }
  b <- data.frame(case = case, low = low, high = high)
  f <- survfit(Surv(ifelse(low == 0, NA, low), ifelse(is.infinite(high), NA, high), type = "interval2") ~ 1)
  shares <- rbind(shares, data.frame(case = case, time = f$time, share = f$surv))
  brackets <- rbind(brackets, b)
}
out(brackets, "brackets.csv"); out(shares, "turnbull.csv")

rates <- data.frame()
for (n in c(0, 1, 5, 23, 400)) {
  t <- poisson.test(n, 2.0, conf.level = 0.95)
  rates <- rbind(rates, data.frame(events = n, time = 2.0, low = t$conf.int[1], high = t$conf.int[2]))
}
out(rates, "rates.csv")
pairs <- data.frame()
for (x in list(c(23, 2, 12, 2), c(5, 1, 20, 2), c(0, 0.5, 7, 2), c(100, 2, 101, 2), c(40, 1, 60, 3))) {
  t <- poisson.test(c(x[1], x[3]), c(x[2], x[4]))
  pairs <- rbind(pairs, data.frame(events_a = x[1], time_a = x[2], events_b = x[3], time_b = x[4], p = t$p.value))
}
out(pairs, "two_rates.csv")

# Fits with cut-offs from 0 on, by survreg.
fits <- data.frame()
for (case in c("whole", "censored", "ties")) {
  d <- data[data$case == case, ]
  for (law in c("exponential", "weibull", "lognormal")) {
    f <- survreg(Surv(time, ended) ~ 1, data = d, dist = law, control = survreg.control(rel.tolerance = 1e-13, maxiter = 200))
    p <- switch(law, exponential = c(exp(coef(f)), 0), weibull = c(exp(coef(f)), 1 / f$scale), lognormal = c(coef(f), f$scale))
    fits <- rbind(fits, data.frame(case = case, shortest = 0, law = c(exponential = "exponential", weibull = "stretched", lognormal = "log_normal")[law],
                                   first = p[1], second = p[2], log_likelihood = f$loglik[1]))
  }
}
# Tails of whole durations from xmin on, by poweRlaw.
tails <- data.frame(case = "pareto", time = 0.002 * runif(300)^(-1 / 1.5))
tails <- rbind(tails, data.frame(case = "mixed", time = 0.002 + rweibull(300, 0.8, 0.01)))
out(tails, "tails.csv")
ratios <- data.frame()
for (case in c("pareto", "mixed")) {
  x <- tails$time[tails$case == case]; xmin <- 0.003
  models <- list(power = conpl$new(x), exponential = conexp$new(x), log_normal = conlnorm$new(x), stretched = conweibull$new(x))
  for (law in names(models)) {
    m <- models[[law]]; m$setXmin(xmin)
    p <- estimate_pars(m)$pars
    # Its search stops early: on from there.
    tail <- x[x >= xmin]
    minus <- switch(law,
      log_normal = function(q) -sum(dlnorm(tail, q[1], exp(q[2]), log = TRUE) - plnorm(xmin, q[1], exp(q[2]), lower.tail = FALSE, log.p = TRUE)),
      stretched = function(q) -sum(dweibull(tail, q[1], exp(q[2]), log = TRUE) - pweibull(xmin, q[1], exp(q[2]), lower.tail = FALSE, log.p = TRUE)))
    if (case == "mixed" && !is.null(minus)) {
      q <- c(p[1], log(p[2]))
      for (again in 1:5) q <- optim(q, minus, control = list(reltol = 1e-15, maxit = 5000))$par
      p <- c(q[1], exp(q[2]))
    }
    m$setPars(p); models[[law]] <- m
    first <- switch(law, exponential = 1 / p[1], stretched = p[2], p[1]); second <- switch(law, log_normal = p[2], stretched = p[1], 0)
    fits <- rbind(fits, data.frame(case = case, shortest = xmin, law = law, first = first, second = second, log_likelihood = dist_ll(m)))
  }
  for (law in c("exponential", "log_normal", "stretched")) {
    c <- compare_distributions(models$power, models[[law]])
    ratios <- rbind(ratios, data.frame(case = case, shortest = xmin, one = "power", other = law, statistic = c$test_statistic, p = c$p_two_sided))
  }
}
out(fits, "fits.csv"); out(ratios, "likelihood_ratios.csv")

// Exact confidence interval of a rate from a count of events (Garwood, Biometrika 28, 1936, 437).

const lanczos = [
  0.99999999999980993, 676.5203681218851, -1259.1392167224028, 771.32342877765313, -176.61502916214059,
  12.507343278686905, -0.13857109526572012, 9.9843695780195716e-6, 1.5056327351493116e-7,
];

export function logGamma(x: number): number {
  const y = x - 1;
  let sum = lanczos[0]!;
  for (let k = 1; k < lanczos.length; ++k) sum += lanczos[k]! / (y + k);
  const t = y + 7.5;
  return 0.5 * Math.log(2 * Math.PI) + (y + 0.5) * Math.log(t) - t + Math.log(sum);
}

// P(a, x), the regularised lower incomplete gamma function: series below x = a + 1, continued fraction above.
export function gammaP(a: number, x: number): number {
  if (x <= 0) return 0;
  const front = Math.exp(a * Math.log(x) - x - logGamma(a));
  if (x < a + 1) {
    let term = 1 / a;
    let sum = term;
    for (let n = 1; n < 10000 && term > sum * 1e-16; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    return front * sum;
  }
  let b = x + 1 - a;
  let c = 1e300;
  let d = 1 / b;
  let h = d;
  for (let n = 1; n < 10000; ++n) {
    const an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    const step = d * c;
    h *= step;
    if (Math.abs(step - 1) < 1e-15) break;
  }
  return 1 - front * h;
}

// The x with P(a, x) = p, by bisection.
export function gammaQuantile(a: number, p: number): number {
  let low = 0;
  let high = a + 12 * Math.sqrt(a) + 60;
  for (let k = 0; k < 200 && high - low > 1e-13 * high; ++k) {
    const middle = 0.5 * (low + high);
    if (gammaP(a, middle) < p) low = middle;
    else high = middle;
  }
  return 0.5 * (low + high);
}

export interface Rate {
  rate: number; // 1/s
  low: number;
  high: number;
}

// chi2(alpha/2; 2n) / 2T and chi2(1 - alpha/2; 2n + 2) / 2T for n events in the time T; exact if events are independent.
export function garwood(events: number, time: number, confidence = 0.95): Rate | null {
  if (!(time > 0) || !(events >= 0)) return null;
  const tail = (1 - confidence) / 2;
  return {
    rate: events / time,
    low: events === 0 ? 0 : gammaQuantile(events, tail) / time,
    high: gammaQuantile(events + 1, 1 - tail) / time,
  };
}

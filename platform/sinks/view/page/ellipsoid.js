// The 95 % ellipsoid of a covariance.

// 95 % quantile of chi-square with 3 degrees of freedom.
const CHI_SQUARE_95 = 7.814727903251179;

// Eigenvalues and eigenvectors (columns) of a symmetric 3 x 3 matrix, rows first, by Jacobi
// rotations (Golub and Van Loan 2013, section 8.5.2).
export function eigenOfSymmetric(matrix) {
  const a = [matrix.slice(0, 3), matrix.slice(3, 6), matrix.slice(6, 9)].map((row) => [...row]);
  const vectors = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  const SWEEPS_MAX = 20;
  for (let sweep = 0; sweep < SWEEPS_MAX; ++sweep) {
    const off = a[0][1] ** 2 + a[0][2] ** 2 + a[1][2] ** 2;
    if (off <= 1e-30 * (a[0][0] ** 2 + a[1][1] ** 2 + a[2][2] ** 2)) break;
    for (const [p, q] of [
      [0, 1],
      [0, 2],
      [1, 2],
    ]) {
      if (a[p][q] === 0) continue;
      const theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
      const t = (theta >= 0 ? 1 : -1) / (Math.abs(theta) + Math.sqrt(theta * theta + 1));
      const c = 1 / Math.sqrt(t * t + 1),
        s = t * c;
      for (let k = 0; k < 3; ++k)
        [a[k][p], a[k][q]] = [c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]];
      for (let k = 0; k < 3; ++k)
        [a[p][k], a[q][k]] = [c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]];
      for (const row of vectors)
        [row[p], row[q]] = [c * row[p] - s * row[q], s * row[p] + c * row[q]];
    }
  }
  return { values: [a[0][0], a[1][1], a[2][2]], vectors };
}

// Half axes in metres and their directions (columns, right-handed) of the 95 % ellipsoid of the
// position, of a pose's 6 x 6 covariance. Null if the covariance is none.
export function positionEllipsoid(covariance) {
  const block = [0, 1, 2, 6, 7, 8, 12, 13, 14].map((i) => covariance[i]);
  if (!block.every(Number.isFinite)) return null;
  const { values, vectors } = eigenOfSymmetric(block);
  if (Math.min(...values) < 0 || Math.max(...values) <= 0) return null;
  const [[a, b, c], [d, e, f], [g, h, i]] = vectors;
  const determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
  if (determinant < 0) for (const row of vectors) row[2] = -row[2];
  return { axes: values.map((value) => Math.sqrt(CHI_SQUARE_95 * value)), directions: vectors };
}

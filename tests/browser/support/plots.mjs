// The drawings that a report has to show, told from its report.json.

const mostPolarPlots = 12;

/// Drawings of a characteristic of a drawing.
function ofFinding({local, lines, centers_mm: centers, datums}) {
  const labels = [];
  if (local.length > 1) labels.push(/^Local values/);
  if (lines.length > 0) labels.push(/^Generatrices/);
  if (centers.length > 1 && datums[0]?.kind !== 'plane') labels.push(/^Side view: .* x$/, /^Side view: .* y$/);
  return labels;
}

/// Page one draws the section where the worst call-out is worst, beside the sections of its feature, and its map.
function ofCloud(feature, onPageOne) {
  if (feature.shape === 'plane') return [/^Heights over the face/];
  if (['cone', 'sphere'].includes(feature.shape)) return [/^Deviations on the unrolled surface/];
  const oneSection = feature.shape === 'circle' || feature.layers.length === 1;
  const labels = feature.layers.slice(0, mostPolarPlots).map(() => /deviations about the minimum-zone axis/);
  if (onPageOne && !oneSection) labels.push(/deviations about the minimum-zone axis/);
  labels.push(oneSection ? /^Deviation against the angle/ : /^Deviations on the unrolled surface/);
  if (!oneSection) labels.push(/^Cylinder and its zone in three dimensions/);
  if (feature.layers.some((layer) => layer.filtered)) labels.push(/^Amplitudes of the harmonics/);
  if (feature.poses.length > 1) labels.push(/^f of the poses/);
  if (feature.poses.length > 5) labels.push(/^Poses visited/);
  return labels;
}

const ofAnalysis = {
  spindle: (f) => [/^Part, harmonics recovered/, /^Amplitudes/, /^Noise gain/,
    ...Object.keys(f.spindle.motion).flatMap((axis) => [RegExp(`^Motion ${axis}`), RegExp(`^Asynchronous ${axis}`)])],
  wheel: () => [/^Edge of the wheel/, /^Surface, wheel/, /^Wheel radius over/, /^Form left/],
  contour: (f) => [/^Contour errors t/, /^Main journals/, /^Errors of the C axis/, /^Errors of the X axis/,
    /^Following parts/, /^Non-following parts/, /^Mean contour/,
    ...f.contour.curves.map((_, i) => RegExp(`^Part ${i + 1}`))],
  rotary_axes: () => [/^Residuals of the combined poses/].concat(['alpha', 'beta'].flatMap((axis) => ['shift', 'tilt'].flatMap((kind) =>
    ['x', 'y', 'z'].map((along) => RegExp(`^Axis ${axis}: ${kind} .*${along}`))))),
};

/// Labels (patterns) of the drawings of every feature, and the number of tolerance bars.
/// drawn: heading of the drawing of page one, which names its feature; null: there is none.
export function expected(report, drawn) {
  const labels = [];
  let bars = 0;
  for (const feature of report.features) {
    labels.push(...(feature.cloud ? ofCloud(feature, drawn?.includes(feature.id)) : ofAnalysis[feature.shape](feature)));
    for (const c of feature.characteristics) {
      const value = c.value_um ?? c.value_mm ?? c.finding?.judged[0].value_mm ?? null;
      const both = (c.lower_limit_mm ?? null) !== null && (c.upper_limit_mm ?? null) !== null;
      if (value !== null && (both || (c.tolerance_um ?? null) !== null)) bars += 1;
      if (c.finding) labels.push(...ofFinding(c.finding));
    }
  }
  return {labels, bars};
}

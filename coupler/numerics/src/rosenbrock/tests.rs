//! Orders of convergence, stiff problems with known solutions, tangents, failures.

use super::*;
use crate::{BlockTridiagonal, DenseMatrix, Dual, Number};

/// A system by one text of its rates, with parameters after the unknowns.
pub(crate) struct Text<F, G> {
    parameter: f64,
    plain: F,
    dual: G,
    unknowns: usize,
    integrals: usize,
    least: f64,
}

macro_rules! text {
    ($unknowns:expr, $integrals:expr, $parameter:expr, $function:ident) => {
        Text {
            parameter: $parameter,
            plain: $function::<f64>,
            dual: $function::<Dual<4>>,
            unknowns: $unknowns,
            integrals: $integrals,
            least: f64::INFINITY,
        }
    };
}

impl<F, G> StiffSystem for Text<F, G>
where
    F: Fn(&[f64], f64, &mut [f64]),
    G: Fn(&[Dual<4>], Dual<4>, &mut [Dual<4>]),
{
    fn unknowns(&self) -> usize {
        self.unknowns
    }
    fn integrals(&self) -> usize {
        self.integrals
    }
    fn parameters(&self) -> usize {
        1
    }
    fn direct(&self) -> bool {
        true
    }
    fn rates(&mut self, y: &[f64], out: &mut [f64]) {
        (self.plain)(y, self.parameter, out);
    }
    fn differentiate(&mut self, y: &[f64], out: &mut [f64], derivatives: &mut SystemDerivatives) {
        let n = self.unknowns;
        let at: Vec<Dual<4>> = (0..n).map(|k| Dual::along(y[k], k)).collect();
        let mut all = vec![Dual::constant(0.0); out.len()];
        (self.dual)(&at, Dual::along(self.parameter, 3), &mut all);
        for (row, one) in all.iter().enumerate() {
            out[row] = one.value;
            let slopes = &one.slope[..n];
            if row < n {
                derivatives.jacobian[row * n..(row + 1) * n].copy_from_slice(slopes);
            } else {
                derivatives.integrals[(row - n) * n..(row - n + 1) * n].copy_from_slice(slopes);
            }
            derivatives.parameters[row] = one.slope[3];
        }
    }
    fn admissible(&self, from: &[f64], to: &[f64]) -> f64 {
        if to[0] < -self.least {
            from[0] / (from[0] - to[0])
        } else {
            1.0
        }
    }
    /// What the first unknown is below zero the first integral gives back.
    fn correct(&mut self, y: &mut [f64], integrals: &mut [f64], tangent: &mut [f64]) {
        if self.least < f64::INFINITY && y[0] < 0.0 {
            integrals[0] += y[0];
            y[0] = 0.0;
            tangent[1] += tangent[0];
            tangent[0] = 0.0;
        }
    }
}

fn robertson<N: Number>(y: &[N], speed: N, out: &mut [N]) {
    let slow = speed * y[0].times(0.04);
    let back = speed * (y[1] * y[2]).times(1e4);
    let fast = speed * (y[1] * y[1]).times(3e7);
    out[0] = back - slow;
    out[1] = slow - back - fast;
    out[2] = fast;
}

type Plain = fn(&[f64], f64, &mut [f64]);
type WithSlopes = fn(&[Dual<4>], Dual<4>, &mut [Dual<4>]);

/// Robertson's problem with all rates at a multiple.
pub(crate) struct Robertson;

impl Robertson {
    pub(crate) fn of(speed: f64) -> Text<Plain, WithSlopes> {
        Text {
            parameter: speed,
            plain: robertson::<f64>,
            dual: robertson::<Dual<4>>,
            unknowns: 3,
            integrals: 0,
            least: f64::INFINITY,
        }
    }
}

/// y' = −p y², of which ∫ y dt = ln(1 + p y₀ t)/p, beside a rotation that makes it a coupled system.
fn nonlinear<N: Number>(y: &[N], p: N, out: &mut [N]) {
    out[0] = -(p * y[0] * y[0]);
    out[1] = y[2] * y[0];
    out[2] = -(y[1] * y[0]);
    out[3] = y[0];
}

fn van_der_pol<N: Number>(y: &[N], stiffness: N, out: &mut [N]) {
    out[0] = y[1];
    out[1] = ((N::constant(1.0) - y[0] * y[0]) * y[1] - y[0]) * stiffness;
}

fn decay<N: Number>(y: &[N], rate: N, out: &mut [N]) {
    out[0] = -(rate * (y[0] - N::constant(0.25)));
    out[1] = rate * y[0];
}

/// Constant consumption until the end, as a linear share of the last 1e-6: reaches zero and stays there.
fn exhaustion<N: Number>(y: &[N], rate: N, out: &mut [N]) {
    let share = if y[0].value() >= 1e-6 {
        N::constant(1.0)
    } else if y[0].value() >= 0.0 {
        y[0].times(1e6)
    } else {
        N::constant(0.0)
    };
    out[0] = -(rate * share);
    out[1] = rate * share;
}

fn method(tableau: &'static RosenbrockTableau, n: usize) -> Rosenbrock<DenseMatrix> {
    Rosenbrock::new(tableau, DenseMatrix::new(n))
}

const BOTH: [&RosenbrockTableau; 2] = [&RosenbrockTableau::RODAS3, &RosenbrockTableau::RODAS4];

#[test]
fn errors_fall_with_the_order_of_each_method_in_unknowns_and_integrals() {
    for (tableau, order) in BOTH.into_iter().zip([3.0, 4.0]) {
        let error = |steps: usize| {
            let mut system = text!(3, 1, 1.5, nonlinear);
            let mut method = method(tableau, 3);
            let (mut y, mut area) = ([1.0, 1.0, 0.0], 0.0);
            for _ in 0..steps {
                // A step that nothing limits is the whole span.
                let open = IntegrationAccuracy::absolute(&[f64::MAX; 4]);
                let done = method
                    .integrate(&mut system, &mut y, 1.0 / steps as f64, open)
                    .unwrap();
                assert_eq!(done.steps, 1);
                area += method.integrals()[0];
            }
            let angle = 2.5f64.ln() / 1.5;
            [
                (y[1] - angle.cos()).hypot(y[2] + angle.sin()),
                (area - angle).abs(),
            ]
        };
        let (coarse, fine) = (error(20), error(40));
        for (coarse, fine) in coarse.into_iter().zip(fine) {
            let found = (coarse / fine).log2();
            assert!((found - order).abs() < 0.25, "{order}: {found}");
        }
    }
}

#[test]
fn a_quick_method_takes_short_spans_and_leaves_long_ones_as_they_are() {
    let follow = |span: f64, quick: bool| {
        let mut method = method(&RosenbrockTableau::RODAS4, 3);
        if quick {
            method = method.quickly(&RosenbrockTableau::RODAS3);
        }
        let mut y = [1.0, 1.0, 0.0];
        let accuracy = IntegrationAccuracy::absolute(&[1e-6; 4]);
        let mut system = text!(3, 1, 1.5, nonlinear);
        let done = method
            .integrate(&mut system, &mut y, span, accuracy)
            .unwrap();
        (y, done, method.tangent(0).to_vec())
    };
    let (plain, quick) = (follow(1e-3, false), follow(1e-3, true));
    assert_eq!([plain.1.evaluations, quick.1.evaluations], [5, 2]);
    for (one, other) in plain
        .0
        .iter()
        .zip(&quick.0)
        .chain(plain.2.iter().zip(&quick.2))
    {
        assert!((one - other).abs() < 1e-7, "{plain:?} {quick:?}");
    }
    let (plain, quick) = (follow(1.0, false), follow(1.0, true));
    assert!(plain.1.steps > 1);
    assert_eq!((plain.0, plain.2), (quick.0, quick.2));
    assert_eq!(plain.1.evaluations + 2, quick.1.evaluations);
}

#[test]
fn a_quick_method_takes_a_span_where_its_error_is_a_tenth_of_the_tolerance() {
    // The smallest tolerance with which a method takes the span in one step and so many evaluations.
    let least = |mut method: Rosenbrock<DenseMatrix>| {
        let (mut low, mut high) = (1e-12f64, 1.0f64);
        for _ in 0..60 {
            let middle = (low * high).sqrt();
            let mut y = [1.0, 1.0, 0.0];
            let tolerance = [middle; 4];
            let accuracy = IntegrationAccuracy::absolute(&tolerance);
            let mut system = text!(3, 1, 1.5, nonlinear);
            let done = method
                .integrate(&mut system, &mut y, 0.1, accuracy)
                .unwrap();
            match (done.evaluations, done.steps, done.rejected) {
                (2, 1, 0) => high = middle,
                _ => low = middle,
            }
        }
        high
    };
    let plain = least(method(&RosenbrockTableau::RODAS3, 3));
    let quick = least(method(&RosenbrockTableau::RODAS4, 3).quickly(&RosenbrockTableau::RODAS3));
    assert!((quick / plain - 10.0).abs() < 1e-6, "{quick} {plain}");
}

#[test]
fn robertson_s_stiff_problem_agrees_with_its_reference_solution_and_keeps_its_sum() {
    // At t = 40: Hairer and Wanner, IV.10.
    for (tableau, most) in BOTH.into_iter().zip([800, 240]) {
        let mut y = [1.0, 0.0, 0.0];
        let mut method = method(tableau, 3);
        let accuracy = IntegrationAccuracy {
            relative: 1e-7,
            absolute: &[1e-10, 1e-14, 1e-10],
            steps: MOST_STEPS,
        };
        let done = method
            .integrate(&mut Robertson::of(1.0), &mut y, 40.0, accuracy)
            .unwrap();
        for (value, expected) in y
            .iter()
            .zip([0.715_827_069, 9.185_534_765e-6, 0.284_163_745])
        {
            assert!((value / expected - 1.0).abs() < 1e-5, "{y:?}");
        }
        // A linear invariant.
        assert!((y.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        assert!(done.steps + done.rejected < most, "{done:?}");
    }
}

#[test]
fn van_der_pol_s_oscillator_agrees_with_its_reference_solution() {
    // ε = 1e-6, t = 2: Hairer and Wanner, test set for stiff problems ("VDPOL").
    let mut system = text!(2, 0, 1e6, van_der_pol);
    let mut y = [2.0, -0.66];
    let accuracy = IntegrationAccuracy {
        relative: 1e-7,
        absolute: &[1e-7; 2],
        steps: MOST_STEPS,
    };
    let mut method = method(&RosenbrockTableau::RODAS4, 2);
    let done = method
        .integrate(&mut system, &mut y, 2.0, accuracy)
        .unwrap();
    assert!((y[0] / 1.706_167_732_170_469 - 1.0).abs() < 1e-5, "{y:?}");
    assert!(
        (y[1] / -0.892_809_701_024_797_5 - 1.0).abs() < 1e-5,
        "{y:?}"
    );
    assert!(done.steps + done.rejected < 3000, "{done:?}");
}

#[test]
fn a_decay_of_any_rate_ends_at_rest_in_a_few_steps_and_its_tangent_vanishes() {
    for tableau in BOTH {
        for rate in [1e3, 1e9, 1e20, 1e100] {
            let mut y = [1.0];
            let mut method = method(tableau, 1);
            let accuracy = IntegrationAccuracy::absolute(&[1e-6, f64::MAX]);
            let mut system = text!(1, 1, rate, decay);
            let done = method
                .integrate(&mut system, &mut y, 1.0, accuracy)
                .unwrap();
            assert!((y[0] - 0.25).abs() < 1e-6, "{rate}: {y:?}");
            assert!(done.steps + done.rejected < 200, "{rate}: {done:?}");
            // What is still on its way to rest, relative to the way: ∂y/∂k = −(y − ¼) t.
            assert!(
                method.tangent(0)[0].abs() < 1.0 / rate,
                "{:?}",
                method.tangent(0)
            );
        }
    }
}

#[test]
fn the_tangent_is_the_difference_quotient_of_first_order_in_the_step_and_exact_where_linear() {
    let run = |p: f64, steps: usize| {
        let mut system = text!(3, 1, p, nonlinear);
        let mut method = method(&RosenbrockTableau::RODAS4, 3);
        let mut y = [1.0, 1.0, 0.0];
        let mut slope = [0.0; 4];
        // One integration in equal steps, by a tolerance of the step itself.
        let accuracy = IntegrationAccuracy {
            relative: 0.0,
            absolute: &[10f64.powi(-(steps as i32)); 4],
            steps: MOST_STEPS,
        };
        let done = method
            .integrate(&mut system, &mut y, 1.0, accuracy)
            .unwrap();
        slope.copy_from_slice(method.tangent(0));
        (y, method.integrals()[0], slope, done.steps)
    };
    let h = 1e-5;
    let quotient = (run(1.5 + h, 12).1 - run(1.5 - h, 12).1) / (2.0 * h);
    let error = |digits: usize| {
        let (_, _, slope, steps) = run(1.5, digits);
        ((slope[3] / quotient - 1.0).abs(), steps as f64)
    };
    let (coarse, fine) = (error(5), error(11));
    let order = (coarse.0 / fine.0).ln() / (fine.1 / coarse.1).ln();
    assert!(order > 0.8, "{coarse:?} {fine:?}");
    // y = 1/4 + 3/4 exp(−p t): ∂y/∂p = −3/4 t exp(−p t).
    let mut method = method(&RosenbrockTableau::RODAS4, 1);
    let mut y = [1.0];
    let accuracy = IntegrationAccuracy::absolute(&[1e-9, 1e-9]);
    method
        .integrate(&mut text!(1, 1, 2.0, decay), &mut y, 1.0, accuracy)
        .unwrap();
    // The source of the tangent, y itself, changes within a step.
    assert!((method.tangent(0)[0] / (-0.75 * (-2f64).exp()) - 1.0).abs() < 0.05);
}

#[test]
fn what_is_used_up_ends_at_nothing_in_few_steps_never_far_below_and_has_no_slope() {
    for tableau in BOTH {
        for rate in [1.5, 1e3, 1e20] {
            let mut system = text!(1, 1, rate, exhaustion);
            system.least = 1e-6;
            let mut y = [1.0];
            let mut method = method(tableau, 1);
            let accuracy = IntegrationAccuracy::absolute(&[1e-6, 1e-6]);
            let done = method
                .integrate(&mut system, &mut y, 1.0, accuracy)
                .unwrap();
            assert!(y[0].abs() <= 1e-6, "{rate}: {y:?}");
            // All that is made is what was used.
            assert!((method.integrals()[0] - (1.0 - y[0])).abs() < 1e-14);
            assert!(done.steps + done.rejected < 200, "{rate}: {done:?}");
            // A few percent of the slope before the end are left by the step across it.
            let left = method.tangent(0)[1] * rate;
            assert!(left.abs() < 0.05, "{rate}: {left}");
        }
    }
}

#[test]
fn a_chain_in_blocks_takes_the_same_path_as_the_dense_system() {
    /// Diffusion and a fast reaction in ten cells of two species.
    struct Chain<'a> {
        place: &'a dyn Fn((usize, usize), (usize, usize)) -> usize,
    }
    impl StiffSystem for Chain<'_> {
        fn unknowns(&self) -> usize {
            20
        }
        fn rates(&mut self, y: &[f64], out: &mut [f64]) {
            for cell in 0..10 {
                let reaction = 1e4 * y[2 * cell] * y[2 * cell + 1];
                for k in 0..2 {
                    let here = y[2 * cell + k];
                    let left = if cell > 0 { y[2 * cell - 2 + k] } else { 1.0 };
                    let right = if cell < 9 { y[2 * cell + 2 + k] } else { here };
                    out[2 * cell + k] = 50.0 * (left - 2.0 * here + right) - reaction;
                }
            }
        }
        fn differentiate(
            &mut self,
            y: &[f64],
            out: &mut [f64],
            derivatives: &mut SystemDerivatives,
        ) {
            self.rates(y, out);
            for cell in 0..10 {
                for k in 0..2 {
                    let mut set = |to: (usize, usize), value: f64| {
                        derivatives.jacobian[(self.place)((cell, k), to)] += value;
                    };
                    set((cell, k), if cell < 9 { -100.0 } else { -50.0 });
                    if cell > 0 {
                        set((cell - 1, k), 50.0);
                    }
                    if cell < 9 {
                        set((cell + 1, k), 50.0);
                    }
                    set((cell, 0), -1e4 * y[2 * cell + 1]);
                    set((cell, 1), -1e4 * y[2 * cell]);
                }
            }
        }
    }
    let start: Vec<f64> = (0..20).map(|k| 0.1 * (k % 2) as f64).collect();
    let accuracy = IntegrationAccuracy::absolute(&[1e-7; 20]);
    let dense =
        |(row, i): (usize, usize), (column, j): (usize, usize)| (2 * row + i) * 20 + 2 * column + j;
    let mut one = start.clone();
    let mut full = Rosenbrock::new(&RosenbrockTableau::RODAS3, DenseMatrix::new(20));
    let a = full
        .integrate(&mut Chain { place: &dense }, &mut one, 0.3, accuracy)
        .unwrap();
    let algebra = BlockTridiagonal::new(10, 2);
    let places = algebra.clone();
    let blocks = |from: (usize, usize), to: (usize, usize)| places.place(from, to);
    let mut other = start;
    let mut chain = Rosenbrock::new(&RosenbrockTableau::RODAS3, algebra);
    let b = chain
        .integrate(&mut Chain { place: &blocks }, &mut other, 0.3, accuracy)
        .unwrap();
    assert_eq!(a, b);
    for (one, other) in one.iter().zip(other) {
        assert!((one - other).abs() < 1e-12, "{one} {other}");
    }
}

fn undefined<N: Number>(y: &[N], _: N, out: &mut [N]) {
    out[0] = (y[0] - N::constant(1.0)).ln();
}

#[test]
fn rates_that_are_nan_are_an_error_at_once() {
    let mut method = method(&RosenbrockTableau::RODAS4, 1);
    let accuracy = IntegrationAccuracy::absolute(&[1e-8]);
    let mut system = text!(1, 0, 0.0, undefined);
    let error = method
        .integrate(&mut system, &mut [0.5], 1.0, accuracy)
        .unwrap_err();
    assert_eq!((error.cause, error.reached), (StallCause::NotFinite, 0.0));
    assert!(error.to_string().contains("not finite"), "{error}");
}

#[test]
fn too_few_steps_and_a_solution_that_ends_are_errors_that_say_where() {
    let mut method = method(&RosenbrockTableau::RODAS4, 3);
    let accuracy = IntegrationAccuracy {
        relative: 1e-7,
        absolute: &[1e-10; 3],
        steps: 5,
    };
    let error = method.integrate(
        &mut Robertson::of(1.0),
        &mut [1.0, 0.0, 0.0],
        40.0,
        accuracy,
    );
    let error = error.unwrap_err();
    assert_eq!(error.cause, StallCause::Steps(5));
    assert!(
        error.reached < 40.0 && error.to_string().contains("5 steps"),
        "{error}"
    );
    fn explosion<N: Number>(y: &[N], _: N, out: &mut [N]) {
        out[0] = y[0] * y[0];
    }
    let mut method = Rosenbrock::new(&RosenbrockTableau::RODAS4, DenseMatrix::new(1));
    // y = 1/(1 − t).
    let accuracy = IntegrationAccuracy {
        relative: 1e-6,
        absolute: &[1e-6],
        steps: MOST_STEPS,
    };
    let error = method.integrate(&mut text!(1, 0, 0.0, explosion), &mut [1.0], 2.0, accuracy);
    let error = error.unwrap_err();
    assert!((error.reached - 1.0).abs() < 1e-3, "{error:?}");
}

#[test]
fn the_direct_effect_of_a_parameter_is_that_of_unknowns_that_do_not_respond() {
    // y' = −p (y − 1/4), z' = p y: ∫ y dτ = (1 − 1/4) (1 − exp(−p t))/p + t/4; the trapezoidal rule over the steps of
    // a tight integration.
    let (rate, span): (f64, f64) = (3.0, 0.7);
    let mut method = method(&RosenbrockTableau::RODAS4, 1);
    let mut system = text!(1, 1, rate, decay);
    let mut y = [1.0];
    let accuracy = IntegrationAccuracy::absolute(&[1e-9, 1e-9]);
    method
        .integrate(&mut system, &mut y, span, accuracy)
        .unwrap();
    let exact = 0.75 * (1.0 - (-rate * span).exp()) / rate + 0.25 * span;
    assert!((method.direct(0)[0] / exact - 1.0).abs() < 1e-3);
    // What is used up in the end has a direct effect, and next to no tangent.
    assert!((method.tangent(0)[1] - exact).abs() > 0.1 * exact);
}

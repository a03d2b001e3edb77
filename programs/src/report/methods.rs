//! The compared methods, as data.

use asvgf::{Blend, FilterSettings, Gradient, Kernel, Mode, Settings, TracerSettings, Variance};

/// Purpose of a method in the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Path tracing alone, with this many paths per pixel: shows the gain of more paths.
    Tracing(u32),
    /// A moving average along the motion, not filtered in space.
    Average,
    /// A constant α, in the published filter (svgf) and in the crate's own (constant): the best of each sequence is the
    /// rival of an adaptive α.
    Constant,
    /// An adaptive α.
    Adaptive,
    /// The default with other numbers of spatial iterations.
    Iterations,
    /// The default without one of its ideas.
    Ablation,
    /// Deliberately worse: a report that fails to show it is wrong.
    Control,
    /// Another denoiser.
    Baseline,
}

#[derive(Clone, Debug)]
pub struct Method {
    pub name: String,
    pub group: Group,
    pub settings: Settings,
}

/// Name of the method in all comparisons with the others: the crate's default.
pub const DEFAULT: &str = "a-svgf";
/// Name of path tracing at one path per pixel.
pub const ONE_PATH: &str = "1 spp";
/// Name of the deliberately worse method.
pub const CONTROL: &str = "worse on purpose";

/// Candidates for the best constant α.
pub const ALPHAS: [f32; 7] = [0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0];

/// Returns a few methods of each kind, and every constant α.
pub fn quick() -> Vec<Method> {
    const CHOICE: [&str; 10] = [
        ONE_PATH,
        "4 spp",
        "16 spp",
        "average 0.2",
        DEFAULT,
        "classic",
        "blinn-phong",
        "2 iterations",
        "without ratio",
        CONTROL,
    ];
    let chosen = |method: &Method| method.group == Group::Constant || CHOICE.contains(&method.name.as_str());
    all().into_iter().filter(chosen).collect()
}

/// Returns all methods, the most informative first and the slowest last, because a budget cuts off the end.
pub fn all() -> Vec<Method> {
    let mut methods = vec![adaptive(DEFAULT, FilterSettings::default())];
    methods.extend([1, 2, 4, 8, 16].map(tracing));
    for alpha in ALPHAS {
        for (name, filter) in [("svgf", Settings::classic()), ("constant", Settings::adaptive())] {
            let settings = filter.constant(alpha);
            methods.push(Method { name: format!("{name} {alpha}"), group: Group::Constant, settings });
        }
    }
    methods.push(adaptive("classic", FilterSettings::classic()));
    for alpha in [0.2, 0.05] {
        let settings = filter(FilterSettings { iterations: 0, ..Default::default() }).constant(alpha);
        methods.push(Method { name: format!("average {alpha}"), group: Group::Average, settings });
    }
    methods.push(adaptive("blinn-phong", with(|f| f.gradient = Gradient::BlinnPhong)));
    methods.push(adaptive("statistics", with(|f| f.gradient = Gradient::Statistics)));
    for (name, change) in ABLATIONS {
        methods.push(Method { name: name.into(), group: Group::Ablation, settings: filter(with(change)) });
    }
    for iterations in [0, 1, 2, 3, 5] {
        let name = if iterations == 1 { "1 iteration".into() } else { format!("{iterations} iterations") };
        let settings = filter(FilterSettings { iterations, ..Default::default() });
        methods.push(Method { name, group: Group::Iterations, settings });
    }
    let worse = with(|f| (f.sigma_luminance, f.alpha) = (0.0, 1.0));
    methods.push(Method { name: CONTROL.into(), group: Group::Control, settings: filter(worse) });
    methods.extend([32, 64].map(tracing));
    methods
}

type Change = fn(&mut FilterSettings);

/// The default without one of its ideas (docs/filter.md), for each idea.
const ABLATIONS: [(&str, Change); 20] = [
    ("without gradient", |f| f.gradient = Gradient::Off),
    ("without ratio", |f| f.history_ratio = false),
    ("without linear fit", |f| f.local_linear_fit = false),
    ("constant ridge", |f| f.ridge_noise = 0.0),
    ("without final iteration", |f| f.final_iteration = false),
    ("without steadiness", |f| f.steadiness = 0.0),
    ("without outlier limit", |f| f.outlier_limit = 0.0),
    ("with feedback", |f| f.feedback = true),
    ("variance of a sample", |f| f.variance = Variance::OfSample),
    ("classic stops", |f| {
        let FilterSettings { stops, sigma_depth, sigma_normal, .. } = FilterSettings::classic();
        (f.stops, f.sigma_depth, f.sigma_normal) = (stops, sigma_depth, sigma_normal);
    }),
    ("without foreshortening", |f| f.sigma_foreshortening = 0.0),
    ("filter what has converged", |f| f.converged = 0.0),
    ("25 taps", |f| f.kernel = Kernel::Full),
    ("blend by lambda", |f| f.blend = Blend::Lambda),
    ("gradient by surface", |f| f.gradient_across_surfaces = false),
    // Four ideas for specular light; where nothing shines, they change nothing.
    ("one signal", |f| f.gloss = false),
    ("without gloss clamp", |f| f.gloss_clamp = 0.0),
    ("diffuse stop for gloss", |f| f.gloss_sigma_luminance = f.sigma_luminance),
    ("diffuse power for gloss", |f| f.gloss_history_power = f.history_power),
    ("signed gradient", |f| {
        // The documentation of the signed gradient recommends these settings.
        (f.gradient_signed, f.gradient_iterations, f.gradient_dead_zone) = (true, 5, 0.1);
    }),
];

/// Returns path tracing alone, with this many paths per pixel.
fn tracing(samples: u32) -> Method {
    let tracer = TracerSettings { samples, ..Default::default() };
    let settings = Settings { mode: Mode::Noisy, tracer, ..Settings::adaptive() };
    Method { name: format!("{samples} spp"), group: Group::Tracing(samples), settings }
}

fn adaptive(name: &str, settings: FilterSettings) -> Method {
    Method { name: name.into(), group: Group::Adaptive, settings: filter(settings) }
}

fn filter(filter: FilterSettings) -> Settings {
    Settings { filter, ..Settings::adaptive() }
}

/// Returns the default with one change.
fn with(change: impl FnOnce(&mut FilterSettings)) -> FilterSettings {
    let mut filter = FilterSettings::default();
    change(&mut filter);
    filter
}

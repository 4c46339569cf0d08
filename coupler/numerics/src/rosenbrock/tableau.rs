//! Coefficients of Rosenbrock methods.

/// Most stages of a method.
pub const MOST_STAGES: usize = 6;

type Coefficients = [[f64; MOST_STAGES]; MOST_STAGES];

/// Coefficients of a Rosenbrock method of autonomous systems, in the form without products of the Jacobian
/// ([`super::Rosenbrock`] has the equations).
#[derive(Clone, Debug, PartialEq)]
pub struct RosenbrockTableau {
    /// Number of stages.
    pub stages: usize,
    /// γ.
    pub gamma: f64,
    /// a.
    pub a: Coefficients,
    /// c.
    pub c: Coefficients,
    /// Weights m of the result.
    pub m: [f64; MOST_STAGES],
    /// Weights e of the error.
    pub e: [f64; MOST_STAGES],
    /// False where a stage uses the rates of the one before.
    pub fresh: [bool; MOST_STAGES],
    /// Power of the step by which the error estimate falls.
    pub error_order: u8,
}

impl RosenbrockTableau {
    /// RODAS3: third order with an error estimate of second, four stages with three evaluations, stiffly accurate,
    /// L-stable.
    ///
    /// Source: Sandu, Verwer, Blom, Spee, Carmichael and Potra, Atmos. Environ. 31 (1997) 3459,
    /// doi 10.1016/S1352-2310(97)83212-8.
    pub const RODAS3: Self = Self {
        stages: 4,
        gamma: 0.5,
        a: [
            [0.0; 6],
            [0.0; 6],
            [2.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [2.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            [0.0; 6],
            [0.0; 6],
        ],
        c: [
            [0.0; 6],
            [4.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [1.0, -1.0, 0.0, 0.0, 0.0, 0.0],
            [1.0, -1.0, -8.0 / 3.0, 0.0, 0.0, 0.0],
            [0.0; 6],
            [0.0; 6],
        ],
        m: [2.0, 0.0, 1.0, 1.0, 0.0, 0.0],
        e: [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        fresh: [true, false, true, true, false, false],
        error_order: 3,
    };

    /// RODAS: fourth order with an error estimate of third, six stages, stiffly accurate, L-stable.
    ///
    /// Source: Hairer and Wanner, Solving Ordinary Differential Equations II, 2nd ed. (1996), section VI.4,
    /// doi 10.1007/978-3-642-05221-7.
    pub const RODAS4: Self = Self {
        stages: 6,
        gamma: 0.25,
        a: [
            [0.0; 6],
            [1.544, 0.0, 0.0, 0.0, 0.0, 0.0],
            [
                0.946_678_528_081_582_6,
                0.255_701_169_898_328_4,
                0.0,
                0.0,
                0.0,
                0.0,
            ],
            [
                3.314_825_187_068_521,
                2.896_124_015_972_201,
                0.998_641_913_997_781_7,
                0.0,
                0.0,
                0.0,
            ],
            [
                1.221_224_509_226_641,
                6.019_134_481_288_629,
                12.537_083_329_320_87,
                -0.687_886_036_105_895,
                0.0,
                0.0,
            ],
            [
                1.221_224_509_226_641,
                6.019_134_481_288_629,
                12.537_083_329_320_87,
                -0.687_886_036_105_895,
                1.0,
                0.0,
            ],
        ],
        c: [
            [0.0; 6],
            [-5.6688, 0.0, 0.0, 0.0, 0.0, 0.0],
            [
                -2.430_093_356_833_875,
                -0.206_359_915_709_191_5,
                0.0,
                0.0,
                0.0,
                0.0,
            ],
            [
                -0.107_352_905_815_137_5,
                -9.594_562_251_023_355,
                -20.470_286_148_096_16,
                0.0,
                0.0,
                0.0,
            ],
            [
                7.496_443_313_967_647,
                -10.246_804_314_643_52,
                -33.999_903_528_199_05,
                11.708_908_932_061_6,
                0.0,
                0.0,
            ],
            [
                8.083_246_795_921_522,
                -7.981_132_988_064_893,
                -31.521_594_328_743_71,
                16.319_305_431_231_36,
                -6.058_818_238_834_054,
                0.0,
            ],
        ],
        m: [
            1.221_224_509_226_641,
            6.019_134_481_288_629,
            12.537_083_329_320_87,
            -0.687_886_036_105_895,
            1.0,
            1.0,
        ],
        e: [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        fresh: [true; 6],
        error_order: 4,
    };
}

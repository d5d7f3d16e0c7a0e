//! Blurs by the cascade: as wide as they should be, keeping light, and wrapped at borders as the patch is.

use subsurf_decoder::bssrdf::Addressing;
use subsurf_decoder::bssrdf::basis::Cascade;

#[test]
fn stages_add_up_to_the_gaussians() {
    const SIDE: u32 = 129;
    let sigmas = [0.45_f32, 1.1, 2.4, 5.6];
    // What a line of light becomes, step by step.
    let mut line = vec![0.0_f32; SIDE as usize];
    line[64] = 1.0;
    let mut between = line.clone();
    for (stage, sigma) in Cascade::new(sigmas).stages().iter().zip(sigmas) {
        stage.blur(&mut line, &mut between, [SIDE, 1], Addressing::Clamp);
        let at = |x: i16| (-0.5 * (f32::from(x) / sigma).powi(2)).exp();
        let sum: f32 = (-64..=64).map(at).sum();
        for (x, found) in (-64..=64).zip(&line) {
            let error = (found - at(x) / sum).abs() * sum;
            assert!(error < 0.025, "σ = {sigma}: {error} of the peak at {x}");
        }
    }
    assert!(Cascade::new(sigmas).stages().iter().all(|stage| stage.taps <= 7), "few taps");
}

#[test]
fn light_is_kept_and_borders_are_addressed() {
    // Narrower than the widest stage reaches: it wraps more than once.
    const SIZE: [u32; 2] = [5, 3];
    const PAD: u32 = 24;
    let plane: Vec<f32> = (0..15_u8).map(|k| f32::from(k * k % 11)).collect();
    for addressing in [Addressing::Clamp, Addressing::Repeat, Addressing::Mirror] {
        // The same plane with what lies around it, which a blur without borders sees.
        let around = SIZE.map(|side| side + 2 * PAD);
        let at = |x: u32, y: u32| {
            let [x, y] = [x, y].map(|k| k.cast_signed() - PAD.cast_signed());
            plane[(addressing.map(y, SIZE[1]) * SIZE[0] + addressing.map(x, SIZE[0])) as usize]
        };
        let wide: Vec<f32> =
            (0..around[1]).flat_map(|y| (0..around[0]).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect();
        for stage in Cascade::new([0.6, 1.5, 4.0]).stages() {
            let (mut found, mut expected) = (plane.clone(), wide.clone());
            stage.blur(&mut found, &mut [0.0; 15], SIZE, addressing);
            stage.blur(&mut expected, &mut vec![0.0; wide.len()], around, Addressing::Clamp);
            for (k, found) in (0_u32..).zip(&found) {
                let expected = expected[((k / SIZE[0] + PAD) * around[0] + k % SIZE[0] + PAD) as usize];
                assert!((found - expected).abs() < 1e-4, "{addressing:?}, pixel {k}: {found}, {expected}");
            }
            let sums = [&plane, &found].map(|plane| plane.iter().sum::<f32>());
            assert!(addressing == Addressing::Clamp || (sums[0] - sums[1]).abs() < 1e-3, "{addressing:?}: {sums:?}");
        }
    }
}

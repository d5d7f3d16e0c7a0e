// Two weighted irradiance maps, L = 2: targets of the passes that draw them.

const TERMS: u32 = 2u;

struct Maps {
    @location(0) first: TargetTexel,
    @location(1) second: TargetTexel,
}

struct MapsAndSums {
    @location(0) first: TargetTexel,
    @location(1) second: TargetTexel,
    @location(2) first_sum: TargetTexel,
    @location(3) second_sum: TargetTexel,
}

// Targets for the maps.
fn maps_of(maps: array<vec4<f32>, TERMS>) -> Maps {
    return Maps(pack(maps[0]), pack(maps[1]));
}

// Targets for the maps and the sums.
fn maps_and_sums_of(maps: array<vec4<f32>, TERMS>, sums: array<vec4<f32>, TERMS>) -> MapsAndSums {
    return MapsAndSums(pack(maps[0]), pack(maps[1]), pack(sums[0]), pack(sums[1]));
}

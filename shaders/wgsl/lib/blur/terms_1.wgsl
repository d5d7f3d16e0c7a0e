// One weighted irradiance map.
const TERMS: u32 = 1u;

struct Maps {
    @location(0) first: Kept,
}

struct MapsAndSums {
    @location(0) first: Kept,
    @location(1) first_sum: Kept,
}

fn maps_of(maps: array<vec4<f32>, TERMS>) -> Maps {
    return Maps(kept(maps[0]));
}

fn maps_and_sums_of(maps: array<vec4<f32>, TERMS>, sums: array<vec4<f32>, TERMS>) -> MapsAndSums {
    return MapsAndSums(kept(maps[0]), kept(sums[0]));
}

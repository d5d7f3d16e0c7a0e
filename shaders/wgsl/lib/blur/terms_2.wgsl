// Two weighted irradiance maps.
const TERMS: u32 = 2u;

struct Maps {
    @location(0) first: Kept,
    @location(1) second: Kept,
}

struct MapsAndSums {
    @location(0) first: Kept,
    @location(1) second: Kept,
    @location(2) first_sum: Kept,
    @location(3) second_sum: Kept,
}

fn maps_of(maps: array<vec4<f32>, TERMS>) -> Maps {
    return Maps(kept(maps[0]), kept(maps[1]));
}

fn maps_and_sums_of(maps: array<vec4<f32>, TERMS>, sums: array<vec4<f32>, TERMS>) -> MapsAndSums {
    return MapsAndSums(kept(maps[0]), kept(maps[1]), kept(sums[0]), kept(sums[1]));
}

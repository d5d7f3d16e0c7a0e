//! Files of nested codebooks, through the decoder's own layout.

use subsurf_decoder::Section;
use subsurf_decoder::btf::Material;
use subsurf_decoder::btf::nested::layout::{ChromaSizes, CodebookSize, CodebookSizes, MAX_STAGES, StageSizes};
use subsurf_decoder::container::bits::{PADDING_BYTES, index_bits};

use super::database::{Chain, Database, Item};
use super::slice_exponents::by_means;
use crate::file::container;

impl Database {
    /// Sizes of codebooks as the section `BOOK` has them.
    fn books(&self, chains: &[Chain]) -> CodebookSizes {
        let grid = &self.header.grid;
        let entries = |length: usize, row: usize| u32::try_from(length / row).expect("fewer than 2³² entries");
        let [n_phi, n_theta, n_alpha, n_beta] = [grid.n_phi, grid.n_theta, grid.n_alpha, grid.n_beta].map(usize::from);
        let mut stages = [StageSizes::default(); MAX_STAGES];
        for (books, chain) in stages[..chains.len()].iter_mut().zip(chains) {
            let rows = [(&chain.texels, 1), (&chain.p4, n_phi), (&chain.p3, n_theta), (&chain.p2, n_alpha)];
            *books = StageSizes {
                codebooks: [0, 1, 2, 3]
                    .map(|k| CodebookSize { entries: entries(rows[k].0.len(), rows[k].1), scales: chain.scales[k] }),
                slices: entries(chain.p1.len(), n_beta + 1),
                is_signed: chain.is_signed,
            };
        }
        let chroma = &self.chroma;
        let chroma = ChromaSizes {
            merged: entries(chroma.merged.len(), 1),
            i2: entries(chroma.i2.len(), n_alpha),
            i1: entries(chroma.i1.len(), n_beta),
            colours: entries(chroma.colours.len(), 1),
            tints: entries(chroma.tints.len(), 1),
            first: chroma.first,
            step: chroma.step,
            is_relative: chroma.is_relative,
        };
        CodebookSizes { chroma, stages, count: chains.len() }
    }

    /// Bytes of the file.
    ///
    /// # Panics
    /// If an index or a code needs more bits than there are entries or bits of scales, if the header counts other
    /// materials, if texels and their tints are not equally many, or if there are more than four stages.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let chains: Vec<Chain> =
            self.stages.iter().map(|chain| by_means(chain, self.header.grid.n_beta.into())).collect();
        let books = self.books(&chains);
        assert_eq!(usize::from(self.header.materials), self.materials.len(), "the header counts the materials");
        let mut of_books = books.chroma.to_bytes().to_vec();
        of_books.extend(books.stages[..books.count].iter().flat_map(StageSizes::to_bytes));
        let mut sections = vec![
            (Section::BtfHeader, self.header.to_bytes().to_vec()),
            (Section::Materials, self.materials.iter().flat_map(Material::to_bytes).collect()),
            (Section::CodebookSizes, of_books),
        ];
        for ((number, chain), of_chain) in (0_u8..).zip(&chains).zip(&books.stages) {
            sections.extend(self.stage(number, chain, of_chain, &books.chroma));
        }
        sections.extend(self.chroma_sections(&books));
        container::write(sections.iter().map(|(section, bytes)| (*section, &bytes[..])))
    }

    fn stage(&self, number: u8, chain: &Chain, books: &StageSizes, chroma: &ChromaSizes) -> [(Section, Vec<u8>); 5] {
        let section = |book| Section::Codebook { book, stage: number };
        let widths = books.index_bits(number == 0, chroma);
        let fields =
            |which: usize, item: &Item| [(item.index, widths[which]), (item.code, chain.scales[which].bits.into())];
        let packed = |which: usize, items: &[Item]| pack(items.iter().map(|item| fields(which, item)));
        let texels = if number == 0 && chroma.tints > 0 {
            let tints = &self.chroma.texel_tints;
            assert_eq!(chain.texels.len(), tints.len(), "every texel has a tint");
            let bits = index_bits(chroma.tints);
            pack(chain.texels.iter().zip(tints).map(|(item, tint)| {
                let [index, code] = fields(0, item);
                [index, code, (*tint, bits)]
            }))
        } else {
            packed(0, &chain.texels)
        };
        // The lowest eight bits of codes of P2 stand by themselves, where samplers find them.
        let codes = chain.p2.iter().map(|item| item.code.to_le_bytes()[0]);
        let above = u32::from(chain.scales[3].bits.saturating_sub(8));
        let indices = chain.p2.iter().map(|item| [(item.index, widths[3]), (item.code >> 8, above)]);
        [
            (section(6), texels),
            (section(4), packed(1, &chain.p4)),
            (section(3), packed(2, &chain.p3)),
            (section(2), codes.chain(pack(indices)).collect()),
            (section(1), [&chain.p1[..], &[0; PADDING_BYTES]].concat()),
        ]
    }

    fn chroma_sections(&self, books: &CodebookSizes) -> Vec<(Section, Vec<u8>)> {
        let (chroma, sizes) = (&self.chroma, &books.chroma);
        let p2 = index_bits(books.stages[0].codebooks[3].entries);
        let merged = chroma.merged.iter().map(|[luma, hue]| [(*luma, p2), (*hue, index_bits(sizes.i2))]);
        let indices = |items: &[u32], len: u32| pack(items.iter().map(|item| [(*item, index_bits(len))]));
        let mut sections = vec![
            (Section::Merged, pack(merged)),
            (Section::ChromaSlices2, indices(&chroma.i2, sizes.i1)),
            (Section::ChromaSlices1, indices(&chroma.i1, sizes.colours)),
            (Section::Colours, chroma.colours.as_flattened().to_vec()),
        ];
        if !chroma.tints.is_empty() {
            sections.push((Section::Tints, chroma.tints.as_flattened().to_vec()));
        }
        sections
    }
}

/// Items without gaps, each of fields (value, bits), the lowest bit first; and the padding that readers need.
fn pack<const FIELDS: usize>(items: impl Iterator<Item = [(u32, u32); FIELDS]>) -> Vec<u8> {
    let mut out = Vec::new();
    // Fewer than 8 bits wait between fields.
    let (mut waiting, mut count) = (0_u64, 0);
    for (value, bits) in items.flatten() {
        assert!(u64::from(value) >> bits == 0, "{value} has more than {bits} bits");
        waiting |= u64::from(value) << count;
        count += bits;
        while count >= 8 {
            out.push(waiting.to_le_bytes()[0]);
            waiting >>= 8;
            count -= 8;
        }
    }
    if count > 0 {
        out.push(waiting.to_le_bytes()[0]);
    }
    out.resize(out.len() + PADDING_BYTES, 0);
    out
}

#[cfg(test)]
mod tests;

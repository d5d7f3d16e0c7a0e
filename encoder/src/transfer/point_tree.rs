//! Hierarchy of points, in which far ones are taken together (Jensen and Buhler 2002, *A rapid hierarchical rendering technique
//! for translucent materials*, section 3).

use std::ops::Range;

use glam::Vec3;

/// Points of a leaf, at most.
const LEAF: usize = 8;

/// Node of a [`PointTree`].
pub(super) struct Node {
    /// Mean of the points' positions weighted by their areas, in mm.
    pub(super) centre: Vec3,
    /// Distance of the farthest point from there, in mm.
    pub(super) radius: f32,
    /// The node's points, as a range of [`PointTree::order`].
    pub(super) points: Range<usize>,
    /// Number of the second of two children; the first follows the node. `None` of leaves.
    pub(super) second: Option<usize>,
}

/// Points in a binary tree, each node of which is a range of them; parents before their children.
pub(super) struct PointTree {
    /// Numbers of the points, those of a node beside each other.
    pub(super) order: Vec<u32>,
    pub(super) nodes: Vec<Node>,
}

impl PointTree {
    /// Tree of points, of which there is at least one, with their areas.
    pub(super) fn new(positions: &[Vec3], areas: &[f32]) -> Self {
        let order = (0..u32::try_from(positions.len()).expect("fewer than 2³² points")).collect();
        let mut tree = Self { order, nodes: Vec::new() };
        tree.split(0..positions.len(), positions, areas);
        tree
    }

    fn split(&mut self, range: Range<usize>, positions: &[Vec3], areas: &[f32]) {
        let number = self.nodes.len();
        let members = &mut self.order[range.clone()];
        let at = |k: &u32| positions[*k as usize];
        // Points without area count a little, so that there is a mean.
        let weigh = |(sum, weight): (Vec3, f32), k: &u32| {
            let area = areas[*k as usize].max(f32::MIN_POSITIVE);
            (sum + area * at(k), weight + area)
        };
        let (sum, weight) = members.iter().fold((Vec3::ZERO, 0.0), weigh);
        let centre = sum / weight;
        let radius = members.iter().map(|k| at(k).distance(centre)).fold(0.0, f32::max);
        let is_leaf = members.len() <= LEAF;
        let middle = members.len() / 2;
        if !is_leaf {
            let [low, high] = members
                .iter()
                .fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], k| [low.min(at(k)), high.max(at(k))]);
            let axis = (high - low).max_position();
            members.select_nth_unstable_by(middle, |a, b| at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(b)));
        }
        self.nodes.push(Node { centre, radius, points: range.clone(), second: None });
        if !is_leaf {
            self.split(range.start..range.start + middle, positions, areas);
            self.nodes[number].second = Some(self.nodes.len());
            self.split(range.start + middle..range.end, positions, areas);
        }
    }

    /// Numbers of the leaves.
    pub(super) fn leaves(&self) -> Vec<usize> {
        (0..self.nodes.len()).filter(|k| self.nodes[*k].second.is_none()).collect()
    }
}

//! Texture reads of a shader, counted in its intermediate representation.

use std::collections::{BTreeMap, HashMap};

use anyhow::{Context, anyhow, bail};
use naga::{BinaryOperator, Block, Expression, Function, Handle, Literal, LocalVariable, Module, Statement, TypeInner};

/// Reads of textures by one invocation, by their names: loads, and samples whatever they filter.
pub(super) type Reads = BTreeMap<String, f64>;

/// What the text of a shader leaves open.
pub(super) struct Assumptions<'a> {
    /// Turns of loops that have no constant end, or do not get there: function, variable, turns.
    pub(super) turns: &'a [(&'a str, &'a str, f64)],
    /// Shares of invocations that take a branch: function, number of the branch among those of the function that read or
    /// return, share.
    pub(super) shares: &'a [(&'a str, usize, f64)],
}

/// Counts what an entry point reads; the cases of a switch are taken equally often.
///
/// # Errors
/// If a loop or a branch with reads in it is neither constant nor among the assumptions.
pub(super) fn reads(module: &Module, entry: &str, assumed: &Assumptions<'_>) -> anyhow::Result<Reads> {
    let found = module.entry_points.iter().find(|found| found.name == entry);
    let function = &found.with_context(|| format!("no entry point {entry}"))?.function;
    let mut counter = Counter { module, assumed, reads: Reads::new() };
    counter.function(entry, function, Vec::new(), 1.0)?;
    Ok(counter.reads)
}

struct Counter<'a> {
    module: &'a Module,
    assumed: &'a Assumptions<'a>,
    reads: Reads,
}

/// A function on its way through its statements.
struct Frame<'a> {
    name: &'a str,
    function: &'a Function,
    /// Names of textures that it was called with.
    arguments: Vec<Option<String>>,
    /// Numbers of its branches.
    branches: HashMap<*const Statement, usize>,
    /// Constants that variables were set to last.
    constants: HashMap<Handle<LocalVariable>, i64>,
}

impl<'a> Counter<'a> {
    fn function(
        &mut self,
        name: &'a str,
        function: &'a Function,
        arguments: Vec<Option<String>>,
        weight: f64,
    ) -> anyhow::Result<()> {
        let mut branches = HashMap::new();
        self.number(function, &function.body, &mut branches);
        let mut frame = Frame { name, function, arguments, branches, constants: HashMap::new() };
        self.block(&mut frame, &function.body, weight)?;
        Ok(())
    }

    /// Adds the reads of a block that a share `weight` of all invocations begins, and gives the share that comes to its end.
    fn block(&mut self, frame: &mut Frame<'a>, block: &'a Block, mut weight: f64) -> anyhow::Result<f64> {
        for statement in block {
            if weight == 0.0 {
                break;
            }
            match statement {
                Statement::Emit(range) => {
                    for expression in range.clone() {
                        if let Some(image) = image_of(&frame.function.expressions[expression]) {
                            let name = self.texture(frame, image).context("a texture without a name")?;
                            *self.reads.entry(name).or_default() += weight;
                        }
                    }
                }
                Statement::Store { pointer, value } => {
                    if let Expression::LocalVariable(variable) = frame.function.expressions[*pointer]
                        && let Some(value) = self.constant(frame.function, *value)
                    {
                        frame.constants.insert(variable, value);
                    }
                }
                Statement::Call { function, arguments, .. } => {
                    let called = &self.module.functions[*function];
                    if !self.is_reading(called, &called.body) {
                        continue;
                    }
                    let textures = arguments.iter().map(|argument| self.texture(frame, *argument)).collect();
                    self.function(called.name.as_deref().unwrap_or(""), called, textures, weight)?;
                }
                Statement::Block(inner) => weight = self.block(frame, inner, weight)?,
                Statement::If { accept, reject, .. } => {
                    if let Some(number) = frame.branches.get(&std::ptr::from_ref(statement)) {
                        let share = self.share(frame, *number)?;
                        let left = self.block(frame, accept, weight * share)?;
                        weight = left + self.block(frame, reject, weight * (1.0 - share))?;
                    }
                }
                Statement::Loop { body, .. } if self.is_reading(frame.function, body) => {
                    let turns = self.turns(frame, body)?;
                    self.block(frame, body, weight * turns)?;
                }
                Statement::Switch { cases, .. }
                    if cases.iter().any(|case| self.is_reading(frame.function, &case.body)) =>
                {
                    #[allow(clippy::cast_precision_loss, reason = "a handful")]
                    let share = weight / cases.len() as f64;
                    weight = 0.0;
                    for case in cases {
                        weight += self.block(frame, &case.body, share)?;
                    }
                }
                Statement::Return { .. } | Statement::Kill => return Ok(0.0),
                _ => {}
            }
        }
        Ok(weight)
    }

    /// Numbers the branches of a function that read or return, in the order of the text.
    fn number(&self, function: &Function, block: &Block, branches: &mut HashMap<*const Statement, usize>) {
        for statement in block {
            match statement {
                Statement::If { accept, reject, .. } => {
                    if [accept, reject].into_iter().any(|block| self.is_reading(function, block) || is_returning(block))
                    {
                        branches.insert(std::ptr::from_ref(statement), branches.len());
                    }
                    self.number(function, accept, branches);
                    self.number(function, reject, branches);
                }
                Statement::Block(inner) => self.number(function, inner, branches),
                Statement::Loop { body, .. } => self.number(function, body, branches),
                _ => {}
            }
        }
    }

    fn share(&self, frame: &Frame<'_>, number: usize) -> anyhow::Result<f64> {
        let mut shares = self.assumed.shares.iter();
        let found = shares.find(|(function, of, _)| (*function, *of) == (frame.name, number));
        found
            .map(|(.., share)| *share)
            .with_context(|| format!("branch {number} of {}: how often it is taken", frame.name))
    }

    /// Turns of a loop: those assumed for its variable, else from a constant to a constant, by one.
    fn turns(&self, frame: &Frame<'_>, body: &Block) -> anyhow::Result<f64> {
        let expressions = &frame.function.expressions;
        let guard = body.iter().find_map(|statement| match statement {
            Statement::If { condition, .. } => Some(*condition),
            _ => None,
        });
        let Some(&Expression::Binary { op, left, right }) = guard.map(|guard| &expressions[guard]) else {
            bail!("{}: a loop without an end", frame.name);
        };
        let Expression::Load { pointer } = expressions[left] else {
            bail!("{}: a loop without a variable", frame.name);
        };
        let Expression::LocalVariable(variable) = expressions[pointer] else {
            bail!("{}: a loop without a variable", frame.name);
        };
        let name = frame.function.local_variables[variable].name.as_deref().unwrap_or("");
        let mut turns = self.assumed.turns.iter();
        if let Some((.., turns)) = turns.find(|(function, of, _)| (*function, *of) == (frame.name, name)) {
            return Ok(*turns);
        }
        let begin = frame.constants.get(&variable).copied();
        let init = || self.constant(frame.function, frame.function.local_variables[variable].init?);
        let (begin, end) = (begin.or_else(init), self.constant(frame.function, right));
        let last = match op {
            BinaryOperator::Less => 0,
            BinaryOperator::LessEqual => 1,
            _ => bail!("{}: the loop over {name} does not count up", frame.name),
        };
        let turns = begin.zip(end).map(|(begin, end)| end - begin + last);
        let turns = turns.ok_or_else(|| anyhow!("the loop over {name} in {}: how many turns it takes", frame.name))?;
        #[allow(clippy::cast_precision_loss, reason = "a handful")]
        Ok(turns as f64)
    }

    fn constant(&self, function: &Function, expression: Handle<Expression>) -> Option<i64> {
        let literal = match &function.expressions[expression] {
            Expression::Literal(literal) => literal,
            Expression::Constant(constant) => {
                match &self.module.global_expressions[self.module.constants[*constant].init] {
                    Expression::Literal(literal) => literal,
                    _ => return None,
                }
            }
            _ => return None,
        };
        match *literal {
            Literal::I32(value) => Some(value.into()),
            Literal::U32(value) => Some(value.into()),
            _ => None,
        }
    }

    /// Name of a texture: a global variable's, or that of an argument.
    fn texture(&self, frame: &Frame<'_>, expression: Handle<Expression>) -> Option<String> {
        match frame.function.expressions[expression] {
            Expression::GlobalVariable(variable) => {
                let variable = &self.module.global_variables[variable];
                let is_image = matches!(self.module.types[variable.ty].inner, TypeInner::Image { .. });
                variable.name.clone().filter(|_| is_image)
            }
            Expression::FunctionArgument(number) => frame.arguments.get(number as usize).cloned().flatten(),
            _ => None,
        }
    }

    /// Whether there is a read anywhere in a block, or in what it calls.
    fn is_reading(&self, function: &Function, block: &Block) -> bool {
        block.iter().any(|statement| match statement {
            Statement::Emit(range) => {
                range.clone().any(|expression| image_of(&function.expressions[expression]).is_some())
            }
            Statement::Call { function, .. } => {
                let called = &self.module.functions[*function];
                self.is_reading(called, &called.body)
            }
            _ => inner(statement).any(|block| self.is_reading(function, block)),
        })
    }
}

/// Whether there is a return anywhere in a block.
fn is_returning(block: &Block) -> bool {
    let is_return = |statement: &Statement| matches!(statement, Statement::Return { .. } | Statement::Kill);
    block.iter().any(|statement| is_return(statement) || inner(statement).any(is_returning))
}

/// Blocks of a statement.
fn inner(statement: &Statement) -> impl Iterator<Item = &Block> {
    let blocks: Vec<&Block> = match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        Statement::Switch { cases, .. } => cases.iter().map(|case| &case.body).collect(),
        _ => Vec::new(),
    };
    blocks.into_iter()
}

/// Texture that an expression reads.
fn image_of(expression: &Expression) -> Option<Handle<Expression>> {
    match expression {
        Expression::ImageLoad { image, .. } | Expression::ImageSample { image, .. } => Some(*image),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_and_branches_that_nobody_knows_are_named() {
        let module = |text: &str| naga::front::wgsl::parse_str(text).unwrap();
        let text = |body: &str| {
            format!(
                "@group(0) @binding(0) var t: texture_2d<f32>; @group(0) @binding(1) var<uniform> n: u32;
                 @fragment fn f() -> @location(0) vec4<f32> {{ var s = vec4<f32>(0.0); {body} return s; }}"
            )
        };
        let load = "s += textureLoad(t, vec2<u32>(0u), 0);";
        let none = Assumptions { turns: &[], shares: &[] };
        let of = |body: String, assumed: &Assumptions<'_>| reads(&module(&text(&body)), "f", assumed);
        assert_eq!(of(format!("for (var k = -1; k <= 2; k++) {{ {load} }}"), &none).unwrap()["t"], 4.0);
        let open = format!("for (var k = 0u; k < n; k++) {{ {load} }}");
        assert_eq!(of(open.clone(), &Assumptions { turns: &[("f", "k", 7.0)], shares: &[] }).unwrap()["t"], 7.0);
        assert!(of(open, &none).unwrap_err().to_string().contains("the loop over k in f"));
        let branch = format!("if n > 3u {{ {load} return s; }} {load} {load}");
        assert_eq!(of(branch.clone(), &Assumptions { turns: &[], shares: &[("f", 0, 0.25)] }).unwrap()["t"], 1.75);
        assert!(of(branch, &none).unwrap_err().to_string().contains("branch 0 of f"));
    }
}

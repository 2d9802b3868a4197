//! The look-ups' WGSL in the words of GLSL and HLSL: names, comments and order of everything stay, so that who knows one
//! knows all. It is the part of WGSL that the look-ups are written in and no more; of the rest it says so. Each `let` and
//! `var` states its type, functions stand before their use and return no arrays, structures are filled member by member,
//! `select` chooses by one `bool`, and what is passed as a sampler is called `filtering`.

use super::Language;
use super::tokens::{Kind, Token, closing, next, split, text, tokens};
use crate::error::{Error, Result};

/// What the translation is preceded by: what a language cannot say in an expression.
const GLSL: &str = "\
#ifdef GL_ES
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
#endif
#ifdef VULKAN
#define TABLE_BINDING(n) layout(set = 0, binding = n) uniform
#else
#define TABLE_BINDING(n) uniform
#endif
";
const HLSL: &str = "\
int2 texture_size(Texture2D<float4> image) {
    uint width, height;
    image.GetDimensions(width, height);
    return int2(width, height);
}

int3 texture_size(Texture3D<float4> image) {
    uint width, height, depth;
    image.GetDimensions(width, height, depth);
    return int3(width, height, depth);
}
";

/// A text of the look-ups in a language. Errors: WGSL that this does not know, with its words.
pub(super) fn translate(wgsl: &str, language: Language) -> Result<String> {
    match language {
        Language::Wgsl => Ok(wgsl.to_string()),
        Language::Glsl => Ok(format!("{GLSL}\n{}", Writer(language).all(&tokens(wgsl))?)),
        Language::Hlsl => Ok(format!("{HLSL}\n{}", Writer(language).all(&tokens(wgsl))?)),
    }
}

struct Writer(Language);

impl Writer {
    fn hlsl(&self) -> bool {
        self.0 == Language::Hlsl
    }

    fn all(&self, tokens: &[Token]) -> Result<String> {
        let (mut out, mut at) = (String::new(), 0);
        while at < tokens.len() {
            let (written, after) = self.one(tokens, at)?;
            out += &written;
            at = after;
        }
        Ok(out)
    }

    /// What begins at `at`, and where the next thing does.
    fn one(&self, tokens: &[Token], at: usize) -> Result<(String, usize)> {
        let (kind, word) = tokens[at];
        match (kind, word) {
            (Kind::Word, "struct") => self.structure(tokens, at),
            (Kind::Word, "fn") => self.function(tokens, at),
            (Kind::Word, "let" | "var" | "const" | "override") => self.variable(tokens, at),
            (Kind::Word, "if") => self.condition(tokens, at),
            (Kind::Sign, "@") => self.binding(tokens, at),
            (Kind::Word, "array") => self.array(tokens, at),
            (Kind::Word, _) if tokens.get(at + 1).is_some_and(|t| t.1 == "(") => self.call(tokens, at),
            (Kind::Word, _) => Ok((self.word(word).to_string(), at + 1)),
            _ => Ok((word.to_string(), at + 1)),
        }
    }

    fn word<'a>(&self, word: &'a str) -> &'a str {
        const WORDS: [(&str, &str, &str); 9] = [
            ("f32", "float", "float"),
            ("i32", "int", "int"),
            ("vec2f", "vec2", "float2"),
            ("vec3f", "vec3", "float3"),
            ("vec4f", "vec4", "float4"),
            ("vec2i", "ivec2", "int2"),
            ("vec3i", "ivec3", "int3"),
            ("sampler", "sampler", "SamplerState"),
            ("mix", "mix", "lerp"),
        ];
        match WORDS.iter().find(|w| w.0 == word) {
            Some((_, _, hlsl)) if self.hlsl() => hlsl,
            Some((_, glsl, _)) => glsl,
            None => word,
        }
    }

    /// A type and the name that is of it.
    fn declared(&self, name: &str, of: &[Token]) -> Result<String> {
        let of: Vec<Token> = of.iter().filter(|t| t.0 != Kind::Space).copied().collect();
        let of = match text(&of).as_str() {
            "texture_2d<f32>" if self.hlsl() => "Texture2D<float4>",
            "texture_3d<f32>" if self.hlsl() => "Texture3D<float4>",
            "texture_2d<f32>" => "sampler2D",
            "texture_3d<f32>" => "sampler3D",
            _ => match of[..] {
                [(Kind::Word, word)] => self.word(word),
                [(_, "array"), _, (_, item), _, (_, count), _] => {
                    return Ok(format!("{} {name}[{count}]", self.word(item)));
                }
                _ => return Err(format!("{name}: a type that has no translation: {}", text(&of)).into()),
            },
        };
        Ok(format!("{of} {name}"))
    }

    /// `name: type` of a list; nothing of a comment or of space alone.
    fn member(&self, tokens: &[Token]) -> Result<String> {
        let colon = tokens.iter().position(|t| t.1 == ":").ok_or_else(|| refuse(tokens))?;
        let name = next(tokens, 0);
        Ok(text(&tokens[..name]) + &self.declared(tokens[name].1, &tokens[colon + 1..])?)
    }

    fn structure(&self, tokens: &[Token], at: usize) -> Result<(String, usize)> {
        let open = find(tokens, at, "{")?;
        let close = closing(tokens, open).ok_or_else(|| refuse(&tokens[at..]))?;
        let mut out = text(&tokens[at..=open]);
        let members = split(&tokens[open + 1..close]);
        for member in members.iter().filter(|m| next(m, 0) < m.len()) {
            out += &(self.member(member)? + ";");
        }
        Ok((out + "\n};", close + 1))
    }

    fn function(&self, tokens: &[Token], at: usize) -> Result<(String, usize)> {
        let name = next(tokens, at + 1);
        let open = find(tokens, name, "(")?;
        let close = closing(tokens, open).ok_or_else(|| refuse(&tokens[at..]))?;
        let arrow = next(tokens, close + 1);
        let body = find(tokens, close, "{")?;
        if tokens[arrow].1 != "->" {
            return Err(format!("{}: a function that returns nothing", tokens[name].1).into());
        }
        let parameters = split(&tokens[open + 1..close]);
        let kept = parameters.into_iter().filter(|p| next(p, 0) < p.len());
        // GLSL has textures with their samplers in them.
        let kept = kept.filter(|p| self.hlsl() || !text(p).ends_with(": sampler"));
        let kept: Vec<String> = kept.map(|p| self.member(p)).collect::<Result<_>>()?;
        let head = self.declared(tokens[name].1, &tokens[arrow + 1..body])?;
        Ok((format!("{head}{} ", listed(&kept)), body))
    }

    /// A constant, a variable, or an `override`, which is a macro that may be defined before.
    fn variable(&self, tokens: &[Token], at: usize) -> Result<(String, usize)> {
        let name = next(tokens, at + 1);
        let colon = next(tokens, name + 1);
        if tokens.get(colon).is_none_or(|t| t.1 != ":") {
            return Err(format!("{}: states no type", tokens[name].1).into());
        }
        let end = find(tokens, colon, ";")?;
        let equals = (colon..end).find(|&k| tokens[k].1 == "=").unwrap_or(end);
        let declared = self.declared(tokens[name].1, &tokens[colon + 1..equals])?;
        let value = self.all(&tokens[(equals + 1).min(end)..end])?;
        let name = tokens[name].1;
        let written = match tokens[at].1 {
            "override" => format!("#ifndef {name}\n#define {name}{value}\n#endif"),
            "const" if self.hlsl() => format!("static const {declared} ={value};"),
            "const" => format!("const {declared} ={value};"),
            _ if !value.is_empty() => format!("{declared} ={value};"),
            // HLSL refuses to return a structure that is not written everywhere.
            _ if self.hlsl() => format!("{declared} = ({})0;", text(&tokens[colon + 1..end]).trim()),
            _ => format!("{declared};"),
        };
        Ok((written, end + 1))
    }

    fn condition(&self, tokens: &[Token], at: usize) -> Result<(String, usize)> {
        let body = find(tokens, at, "{")?;
        let condition = self.all(&tokens[at + 1..body])?;
        Ok((format!("if ({}) ", condition.trim()), body))
    }

    /// `@group(0) @binding(n) var name: type;`
    fn binding(&self, tokens: &[Token], at: usize) -> Result<(String, usize)> {
        let end = find(tokens, at, ";")?;
        let words: Vec<&str> = tokens[at..end].iter().filter(|t| t.0 != Kind::Space).map(|t| t.1).collect();
        let ["@", "group", "(", _, ")", "@", "binding", "(", n, ")", "var", name, ":", of @ ..] = &words[..]
        else {
            return Err(refuse(&tokens[at..]));
        };
        let sampler = *of == ["sampler"];
        let of: Vec<Token> = of.iter().map(|w| (Kind::Word, *w)).collect();
        let declared = self.declared(name, &of)?;
        let written = match (self.hlsl(), sampler) {
            (true, true) => format!("{declared} : register(s0);"),
            (true, false) => format!("{declared} : register(t{n});"),
            (false, true) => String::new(),
            (false, false) => format!("TABLE_BINDING({n}) {declared};"),
        };
        Ok((written, end + 1))
    }

    /// `array<item, count>(…)`, a value.
    fn array(&self, tokens: &[Token], at: usize) -> Result<(String, usize)> {
        let end = closing(tokens, find(tokens, at, "<")?).ok_or_else(|| refuse(&tokens[at..]))?;
        let parts = split(&tokens[at + 2..end]);
        let [item, count] = parts[..] else { return Err(refuse(&tokens[at..])) };
        let head = format!("{}[{}]", self.all(item)?, text(count).trim());
        self.listed_call(&head, tokens, end + 1)
    }

    fn call(&self, tokens: &[Token], at: usize) -> Result<(String, usize)> {
        let name = tokens[at].1;
        let open = at + 1;
        let close = closing(tokens, open).ok_or_else(|| refuse(&tokens[at..]))?;
        let arguments = split(&tokens[open + 1..close]);
        let written = |k: usize| self.all(arguments[k]).map(|a| a.trim().to_string());
        let written = match (name, arguments.len()) {
            ("select", 3 | 4) => format!("({} ? {} : {})", written(2)?, written(1)?, written(0)?),
            ("textureLoad", 3) if self.hlsl() => format!("{}[{}]", written(0)?, written(1)?),
            ("textureLoad", 3) => format!("texelFetch({}, {}, 0)", written(0)?, written(1)?),
            ("textureSampleLevel", 4) if self.hlsl() => {
                format!("{}.SampleLevel({}, {}, 0.0)", written(0)?, written(1)?, written(2)?)
            }
            ("textureSampleLevel", 4) => format!("textureLod({}, {}, 0.0)", written(0)?, written(2)?),
            ("textureDimensions", 1) if self.hlsl() => format!("texture_size({})", written(0)?),
            ("textureDimensions", 1) => format!("textureSize({}, 0)", written(0)?),
            // HLSL has no constructor of a vector from one number.
            ("vec2f" | "vec3f" | "vec4f", 1) if self.hlsl() && arguments[0][0].0 == Kind::Number => {
                format!("(({}){})", self.word(name), written(0)?)
            }
            _ => return self.listed_call(self.word(name), tokens, open),
        };
        Ok((written, close + 1))
    }

    /// A call or a constructor as it stands, less its samplers in GLSL. HLSL has lists of members for constructors.
    fn listed_call(&self, head: &str, tokens: &[Token], open: usize) -> Result<(String, usize)> {
        let close = closing(tokens, open).ok_or_else(|| refuse(&tokens[open..]))?;
        let arguments = split(&tokens[open + 1..close]);
        let kept = arguments.iter().filter(|a| self.hlsl() || !text(a).trim().ends_with("filtering"));
        let written: Vec<String> = kept.map(|a| self.all(a)).collect::<Result<_>>()?;
        let (last, rest) = written.split_last().ok_or_else(|| refuse(&tokens[open..]))?;
        // After a trailing comma there is space alone.
        let inside = match last.trim() {
            "" => rest.join(",") + last,
            _ => written.join(","),
        };
        let list = self.hlsl() && (head.ends_with(']') || head.starts_with(|c: char| c.is_ascii_uppercase()));
        Ok((if list { format!("{{{inside}}}") } else { format!("{head}({inside})") }, close + 1))
    }
}

/// Parameters on one line, or on a line each where that is too long.
fn listed(parameters: &[String]) -> String {
    const LONG: usize = 90;
    let trimmed: Vec<&str> = parameters.iter().map(|p| p.trim()).collect();
    match trimmed.join(", ") {
        line if line.len() < LONG => format!("({line})"),
        _ => format!("(\n    {}\n)", trimmed.join(",\n    ")),
    }
}

fn find(tokens: &[Token], at: usize, sign: &str) -> Result<usize> {
    (at..tokens.len()).find(|&k| tokens[k].1 == sign).ok_or_else(|| refuse(&tokens[at..]))
}

fn refuse(tokens: &[Token]) -> Error {
    Error::Reason(format!("no translation of: {}", text(&tokens[..tokens.len().min(12)]).trim()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::shader::{ASK_COMPACT, ASK_ELEK2010, COMPACT, ELEK2010, SHELL};

    fn of(wgsl: &str, language: Language) -> String {
        let text = translate(wgsl, language).unwrap();
        text[if language == Language::Glsl { GLSL } else { HLSL }.len() + 1..].to_string()
    }

    /// Each construct that the look-ups use, in the words of both languages.
    #[test]
    fn constructs_have_their_words() {
        for (wgsl, glsl, hlsl) in [
            ("let a: f32 = 1e-6;", "float a = 1e-6;", "float a = 1e-6;"),
            ("var s: Stored;", "Stored s;", "Stored s = (Stored)0;"),
            ("const N: i32 = 2;", "const int N = 2;", "static const int N = 2;"),
            (
                "const a: T = T(vec4f(0e0, 1e0, 2e0, 3e0), array<vec4f, N>(b, c,),);",
                "const T a = T(vec4(0e0, 1e0, 2e0, 3e0), vec4[N](b, c));",
                "static const T a = {float4(0e0, 1e0, 2e0, 3e0), {b, c}};",
            ),
            (
                "struct S { a: vec4f, // b: c\n    d: array<vec4f, N>, }",
                "struct S { vec4 a; // b: c\n    vec4 d[N];\n};",
                "struct S { float4 a; // b: c\n    float4 d[N];\n};",
            ),
            (
                "fn f(image: texture_2d<f32>, filtering: sampler, x: i32,) -> vec2f { return g(image, filtering, x); }",
                "vec2 f(sampler2D image, int x) { return g(image, x); }",
                "float2 f(Texture2D<float4> image, SamplerState filtering, int x) { return g(image, filtering, x); }",
            ),
            ("if !a && b < c { }", "if (!a && b < c) { }", "if (!a && b < c) { }"),
            ("select(a, f(b, c), d > e)", "(d > e ? f(b, c) : a)", "(d > e ? f(b, c) : a)"),
            ("textureLoad(i, vec2i(a, b), 0)", "texelFetch(i, ivec2(a, b), 0)", "i[int2(a, b)]"),
            (
                "textureSampleLevel(i, filtering, at, 0.0)",
                "textureLod(i, at, 0.0)",
                "i.SampleLevel(filtering, at, 0.0)",
            ),
            ("vec2f(textureDimensions(i))", "vec2(textureSize(i, 0))", "float2(texture_size(i))"),
            ("mix(a, vec3f(0.0), t)", "mix(a, vec3(0.0), t)", "lerp(a, ((float3)0.0), t)"),
            (
                "@group(0) @binding(3) var a: texture_3d<f32>;",
                "TABLE_BINDING(3) sampler3D a;",
                "Texture3D<float4> a : register(t3);",
            ),
            ("@group(0) @binding(4) var a: sampler;", "", "SamplerState a : register(s0);"),
            (
                "override H: bool = false;",
                "#ifndef H\n#define H false\n#endif",
                "#ifndef H\n#define H false\n#endif",
            ),
        ] {
            assert_eq!(of(wgsl, Language::Glsl), glsl);
            assert_eq!(of(wgsl, Language::Hlsl), hlsl);
            assert_eq!(translate(wgsl, Language::Wgsl).unwrap(), wgsl);
        }
    }

    /// A construct without a translation is an error that shows it, not code that means something else.
    #[test]
    fn the_rest_is_refused() {
        for (wgsl, named) in [
            ("let a = 1.0;", "a: states no type"),
            ("let a: mat3x3<f32> = b;", "mat3x3<f32>"),
            ("fn f(a: f32) { }", "f: a function that returns nothing"),
            ("@compute fn f() -> f32 { }", "@compute"),
            ("fn f(a: ptr<function, f32>) -> f32 { }", "ptr<function,f32>"),
            ("if a", "if a"),
        ] {
            for language in [Language::Glsl, Language::Hlsl] {
                let reason = translate(wgsl, language).unwrap_err().to_string();
                assert!(reason.contains(named), "{wgsl}: {reason}");
            }
        }
    }

    /// All comments of the sources stand in their translations, and no word of WGSL does.
    #[test]
    fn the_sources_are_translated_whole() {
        let source = [SHELL, COMPACT, ELEK2010, ASK_COMPACT, ASK_ELEK2010].join("\n");
        for language in [Language::Glsl, Language::Hlsl] {
            let text = translate(&source, language).unwrap();
            let comments = |text: &str| text.lines().filter(|l| l.trim().starts_with("//")).count();
            assert!(comments(&source) > 50 && comments(&text) == comments(&source), "{language:?}");
            let code: Vec<Token> = tokens(&text).into_iter().filter(|t| t.0 == Kind::Word).collect();
            for word in
                ["fn", "let", "var", "select", "vec4f", "f32", "i32", "texture_2d", "textureLoad", "override"]
            {
                assert!(!code.iter().any(|t| t.1 == word), "{language:?}: {word}");
            }
        }
    }
}

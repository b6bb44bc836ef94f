//! Options of the command line from the declarations of the library: what a recipe calls `gamma_threshold` is
//! `--gamma-threshold` here, with the same documentation, range and default.

use clap::{Arg, ArgAction, ArgMatches, Command};
use weald::recipe::parameter::{Kind, Parameter};

/// Some parameters as options.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Declared {
    /// The parameters.
    pub(crate) parameters: fn() -> Vec<Parameter>,
    /// Heading in the help.
    pub(crate) heading: &'static str,
    /// Key of a table that they are in, and what their options begin with.
    pub(crate) within: Option<&'static str>,
    /// Keys whose options have other names.
    pub(crate) renamed: &'static [(&'static str, &'static str)],
    /// Keys whose options have a help of their own, which says their default too.
    pub(crate) said: &'static [(&'static str, &'static str)],
    /// Keys that are no options.
    pub(crate) without: &'static [&'static str],
}

impl Declared {
    fn options(&self) -> impl Iterator<Item = (String, Parameter)> + '_ {
        let kept = |parameter: &Parameter| !self.without.contains(&parameter.name);
        (self.parameters)().into_iter().filter(kept).map(|parameter| (self.option(parameter.name), parameter))
    }

    fn option(&self, key: &str) -> String {
        if let Some((_, name)) = self.renamed.iter().find(|(renamed, _)| *renamed == key) {
            return (*name).to_owned();
        }
        let key = key.replace('_', "-");
        self.within.map_or(key.clone(), |table| format!("{table}-{key}"))
    }

    /// Adds the options.
    pub(crate) fn add_to(&self, command: Command) -> Command {
        self.options().fold(command, |command, (option, parameter)| {
            let said = self.said.iter().find(|(key, _)| *key == parameter.name).map(|(_, help)| *help);
            command.arg(argument(&option, &parameter, said).help_heading(self.heading))
        })
    }

    /// Keys and values of the options that are given.
    pub(crate) fn given(&self, matches: &ArgMatches) -> Vec<(String, String)> {
        let given = self.options().filter_map(|(option, parameter)| {
            let text = matches.get_one::<String>(&option)?;
            let key =
                self.within.map_or(parameter.name.to_owned(), |table| format!("{table}.{}", parameter.name));
            Some((key, in_toml(&parameter.kind, text)))
        });
        given.collect()
    }
}

fn argument(option: &str, parameter: &Parameter, said: Option<&'static str>) -> Arg {
    let doc = said.unwrap_or(parameter.doc).split_whitespace().collect::<Vec<_>>().join(" ");
    let unit = if parameter.unit == "1" { String::new() } else { format!(" {}", parameter.unit) };
    let default =
        parameter.default.as_deref().filter(|default| said.is_none() && !["[]", "\"\""].contains(default));
    let default =
        default.map_or(String::new(), |default| format!(" [default: {}{unit}]", default.trim_matches('"')));
    let legal = match &parameter.kind {
        Kind::Table(_) | Kind::Tables(_) | Kind::Text => String::new(),
        Kind::Sides => " [WxH]".to_owned(),
        kind => format!(" [{}{unit}]", kind.in_words().replace('"', "")),
    };
    Arg::new(option.to_owned())
        .long(option.to_owned())
        .value_name(value_name(option))
        .allow_negative_numbers(true)
        .action(ArgAction::Set)
        .help(format!("{}{legal}{default}", doc.trim_end_matches('.')))
}

/// What a help calls the value: the last word of the option.
fn value_name(option: &str) -> String {
    let word = option.rsplit('-').next().unwrap_or(option).to_uppercase();
    if word == "SECOND" { "FPS".to_owned() } else { word }
}

/// A value as a recipe writes it.
fn in_toml(kind: &Kind, text: &str) -> String {
    match kind {
        Kind::Text | Kind::Choice(_) | Kind::Colour | Kind::Crs | Kind::Layer => format!("{text:?}"),
        Kind::Sides => text
            .split_once(['x', 'X'])
            .filter(|sides| [sides.0, sides.1].iter().all(|side| side.trim().parse::<u64>().is_ok()))
            .map_or(text.to_owned(), |(width, height)| format!("[{width}, {height}]")),
        Kind::Numbers(..) if !text.starts_with('[') => format!("[{text}]"),
        _ => text.to_owned(),
    }
}

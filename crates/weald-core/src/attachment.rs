//! What a landscape carries besides layers and plants, without this crate knowing what it is: grass, fractals.

use std::any::Any;
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::sync::Arc;

use crate::error::Error;

/// A kind of thing that a landscape carries by name.
pub trait Attachment: Any + Debug + PartialEq + Send + Sync {
    /// What one of them is called in messages: `grass`. No two kinds share it.
    const KIND: &'static str;
}

/// An attachment whose kind is known at run time alone.
trait Erased: Any + Debug + Send + Sync {
    fn equals(&self, other: &dyn Erased) -> bool;
}

impl<T: Attachment> Erased for T {
    fn equals(&self, other: &dyn Erased) -> bool {
        (other as &dyn Any).downcast_ref::<T>() == Some(self)
    }
}

/// Attachments of all kinds, each by kind and name. Copies share what is attached.
#[derive(Clone, Debug, Default)]
pub(crate) struct Attachments(BTreeMap<(&'static str, String), Arc<dyn Erased>>);

impl Attachments {
    pub(crate) fn insert<T: Attachment>(&mut self, name: &str, attachment: Arc<T>) {
        self.0.insert((T::KIND, name.to_owned()), attachment);
    }

    pub(crate) fn get<T: Attachment>(&self, name: &str) -> Result<Arc<T>, Error> {
        let found = self.0.get(&(T::KIND, name.to_owned())).cloned().and_then(downcast);
        found.ok_or_else(|| {
            let known: Vec<_> = self.all::<T>().map(|(name, _)| name).collect();
            Error::Run(format!("there is no {} `{name}`; the landscape has: {}", T::KIND, known.join(", ")))
        })
    }

    pub(crate) fn all<T: Attachment>(&self) -> impl Iterator<Item = (&str, Arc<T>)> {
        let of_kind = self.0.iter().filter(|((kind, _), _)| *kind == T::KIND);
        of_kind.filter_map(|((_, name), attachment)| Some((name.as_str(), downcast(Arc::clone(attachment))?)))
    }

    pub(crate) fn clear<T: Attachment>(&mut self) {
        self.0.retain(|(kind, _), _| *kind != T::KIND);
    }
}

fn downcast<T: Attachment>(attachment: Arc<dyn Erased>) -> Option<Arc<T>> {
    let attachment: Arc<dyn Any + Send + Sync> = attachment;
    attachment.downcast().ok()
}

impl PartialEq for Attachments {
    fn eq(&self, other: &Self) -> bool {
        let pairs = || self.0.iter().zip(&other.0);
        self.0.len() == other.0.len() && pairs().all(|((a, one), (b, two))| a == b && one.equals(&**two))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq)]
    struct Fence(u32);

    #[derive(Debug, PartialEq)]
    struct Path(u32);

    impl Attachment for Fence {
        const KIND: &'static str = "fence";
    }

    impl Attachment for Path {
        const KIND: &'static str = "path";
    }

    #[test]
    fn kinds_of_one_name_are_kept_apart_and_the_missing_is_named_beside_what_is_there() {
        let mut attachments = Attachments::default();
        attachments.insert("west", Arc::new(Fence(1)));
        attachments.insert("west", Arc::new(Path(2)));
        assert_eq!(*attachments.get::<Fence>("west").expect("attached"), Fence(1));
        assert_eq!(*attachments.get::<Path>("west").expect("attached"), Path(2));
        assert_eq!(attachments.all::<Path>().count(), 1);
        let message = attachments.get::<Fence>("east").expect_err("none").to_string();
        assert_eq!(message, "there is no fence `east`; the landscape has: west");
    }

    #[test]
    fn attachments_are_equal_by_value_and_not_by_place() {
        let with = |number| {
            let mut attachments = Attachments::default();
            attachments.insert("west", Arc::new(Fence(number)));
            attachments
        };
        assert_eq!(with(1), with(1));
        assert_ne!(with(1), with(2));
        assert_ne!(with(1), Attachments::default());
    }
}

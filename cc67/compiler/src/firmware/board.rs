//! The firmware of a board, from the tables and the files of facts of `kmotiondef`.

use kmotiondef::boards::TargetBoard;
use kmotiondef::firmware::Origin;

use super::symbols::signature;
use super::{BuiltIn, FirmwareKind, FirmwareNames, FirmwareSymbol, FirmwareSymbols, Prototype};

impl FirmwareNames for &'static TargetBoard {
    fn board(&self) -> &'static TargetBoard {
        self
    }

    fn prototype(&self, name: &str) -> Option<Prototype> {
        if self.is_default() {
            return BuiltIn.prototype(name);
        }
        let ty = self.function(name)?.ty;
        Some(Prototype { result: ty.result, parameters: ty.params, is_variadic: ty.is_variadic })
    }

    fn origin(&self, name: &str) -> Option<Origin> {
        if self.is_default() { BuiltIn.origin(name) } else { Some(self.function(name)?.origin) }
    }

    fn is_variable(&self, name: &str) -> bool {
        if self.is_default() { BuiltIn.is_variable(name) } else { self.variable(name).is_some() }
    }

    fn is_hidden(&self, name: &str) -> bool {
        TargetBoard::is_hidden(self, name)
    }

    fn is_type(&self, name: &str) -> bool {
        BuiltIn.is_type(name)
    }

    fn names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        let board: &'static TargetBoard = self;
        match board.is_default() {
            true => FirmwareNames::names(&BuiltIn),
            // These names are static, those of other firmwares are not.
            false => Box::new(board.names().map(|name| -> &str { name })),
        }
    }
}

impl FirmwareSymbols for &'static TargetBoard {
    fn find(&self, name: &str) -> Option<FirmwareSymbol> {
        if self.is_default() {
            return BuiltIn.find(name);
        }
        if let Some(address) = self.variable(name) {
            return Some(FirmwareSymbol { address, kind: FirmwareKind::Variable });
        }
        let function = self.function(name)?;
        let classes = function.ty.params.iter().filter_map(|ty| ty.class());
        let signature = signature(classes, function.ty.result, function.ty.is_variadic);
        Some(FirmwareSymbol { address: function.address, kind: FirmwareKind::Function(Some(signature)) })
    }

    fn symbol_names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        FirmwareNames::names(self)
    }

    fn board(&self) -> &'static TargetBoard {
        self
    }
}

//! Functions that firmware 4.34 lacks: one row each. Names, types and addresses are in the files of facts of the boards.

use std::collections::BTreeMap;
use std::sync::Arc;

use kmotiondef::boards::TargetBoard;
use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_at};
use kmotiondef::{Cycles, GuestAddr};
use vm::firmware::Signature;

use super::dispatch::{Handler, handler_of, signature_of};
use super::kogna::{hrpwm, spi};
use super::{kogna, motion, sync};

/// A function that firmware 4.34 lacks.
#[derive(Debug)]
pub(crate) struct LaterFunction {
    /// The name that programs use.
    pub(crate) name: &'static str,
    /// The cost of a call in cycles; not measured, but taken from the nearest function of 4.34.
    pub(crate) cost: Cycles,
    /// The function.
    pub(crate) handler: Handler,
    /// Its signature.
    signature: fn() -> Signature,
}

macro_rules! functions {
    ($($group:ident::$function:ident = $name:ident, cost $cost:literal;)*) => {
        /// All of them.
        pub(crate) const LATER_FUNCTIONS: &[LaterFunction] = &[$(LaterFunction {
            name: stringify!($name),
            cost: Cycles::new($cost),
            handler: |parts, caller| handler_of($group::$function, parts, caller),
            signature: || signature_of($group::$function),
        }),*];
    };
}

functions! {
    motion::jog_at_accel = JogAtAccel, cost 500;
    motion::move_at_vel_accel = MoveAtVelAccel, cost 3372;
    motion::move_at_vel_accel_decel = MoveAtVelAccelDecel, cost 3372;
    motion::move_rel_at_vel_accel = MoveRelAtVelAccel, cost 3372;
    motion::move_rel_at_vel_accel_decel_soft = MoveRelAtVelAccelDecelSoft, cost 3372;
    sync::atomic_set_16 = AtomicSet16, cost 24;
    sync::atomic_clear_16 = AtomicClear16, cost 24;
    hrpwm::set_mode = HRPWM_SetMode, cost 100;
    hrpwm::get_mode = HRPWM_GetMode, cost 100;
    hrpwm::set_dir = HRPWM_GPIO_SetDir, cost 100;
    hrpwm::get_dir = HRPWM_GPIO_GetDir, cost 100;
    hrpwm::set_bit = HRPWM_GPIO_SetBit, cost 100;
    hrpwm::clear_bit = HRPWM_GPIO_ClearBit, cost 100;
    hrpwm::read_bit = HRPWM_GPIO_ReadBit, cost 100;
    spi::set_mode = SPI_SetMode, cost 100;
    spi::get_mode = SPI_GetMode, cost 100;
    spi::set_dir = SPI_GPIO_SetDir, cost 100;
    spi::get_dir = SPI_GPIO_GetDir, cost 100;
    spi::set_bit = SPI_GPIO_SetBit, cost 100;
    spi::clear_bit = SPI_GPIO_ClearBit, cost 100;
    spi::read_bit = SPI_GPIO_ReadBit, cost 100;
    kogna::define_coord_system_8p = DefineCoordSystem8P, cost 100;
    kogna::nand_write_blocks = NandWriteBlocks, cost 100;
    kogna::nand_read_blocks = NandReadBlocks, cost 100;
    kogna::enable_rs422_cmds = EnableRS422Cmds, cost 100;
    kogna::rs422_set_baud_rate = RS422_SetBaudRate, cost 100;
    kogna::rs422_get_char = RS422_GetChar, cost 100;
    kogna::rs422_put_char = RS422_PutChar, cost 100;
}

/// A function that programs call.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Callee {
    /// The one with this number in the table of firmware functions.
    Row(usize),
    /// One that firmware 4.34 lacks, by its position in the list.
    Later(usize),
}

/// The functions of a board by address; `None` for the functions of the table.
#[derive(Clone, Debug, Default)]
pub(crate) struct Callees(Option<Arc<BTreeMap<GuestAddr, Callee>>>);

impl Callees {
    /// Those of a board.
    pub(crate) fn for_board(board: &TargetBoard) -> Self {
        if board.is_default() {
            return Self::default();
        }
        let rows = FIRMWARE_FUNCTIONS.iter().map(|row| row.name).zip((0..).map(Callee::Row));
        let later = LATER_FUNCTIONS.iter().map(|function| function.name).zip((0..).map(Callee::Later));
        let with_address = |(name, callee)| Some((board.function(name)?.address, callee));
        Self(Some(Arc::new(rows.chain(later).filter_map(with_address).collect())))
    }

    /// The function at an address.
    #[inline]
    pub(crate) fn callee_at(&self, address: GuestAddr) -> Option<Callee> {
        match &self.0 {
            None => function_at(address).map(Callee::Row),
            Some(callees) => callees.get(&address).copied(),
        }
    }
}

/// All signatures, in order.
pub(crate) fn signatures() -> Vec<Signature> {
    LATER_FUNCTIONS.iter().map(|function| (function.signature)()).collect()
}
